#pragma once

#include "scree/core/obstacle.hpp"
#include "scree/detect/clusters.hpp"
#include "scree/detect/network.hpp"
#include "scree/detect/stage_counts.hpp"

namespace scree {

/// Writes an obstacle, numbered from 1, for each cluster that the network takes for one with at
/// least so much confidence. A rock below the ground and a hole above it are the network's errors,
/// and left out.
void classify(std::span<const Cluster> clusters, const Network& network, double min_confidence,
              FixedVector<Obstacle>& obstacles, StageCounts& counts);

}  // namespace scree
