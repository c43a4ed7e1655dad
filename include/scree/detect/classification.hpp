#pragma once

#include "scree/core/obstacle.hpp"
#include "scree/detect/clusters.hpp"
#include "scree/detect/enclosing_polygon.hpp"
#include "scree/detect/ground_edges.hpp"
#include "scree/detect/network.hpp"
#include "scree/detect/stage_counts.hpp"

namespace scree {

/// Writes an obstacle for each cluster that the network takes for one with at least so much
/// confidence. A rock below the ground and a hole above it are the network's errors, and left out.
/// Where there is no room for all, the nearest stay.
/// @param robot its place in the cloud
/// @param polygons make the footprints
void classify(const ClusteredPoints& found, const Network& network, double min_confidence,
              const Eigen::Vector2f& robot, EnclosingPolygons& polygons,
              FixedVector<Obstacle>& obstacles, StageCounts& counts);

/// Adds the edges that no obstacle covers. Obstacles that are pieces of an edge go: it stands for
/// them. The nearest stay, as above.
void add_edges(const GroundEdges& edges, const Eigen::Vector2f& robot, EnclosingPolygons& polygons,
               FixedVector<Obstacle>& obstacles, StageCounts& counts);

}  // namespace scree
