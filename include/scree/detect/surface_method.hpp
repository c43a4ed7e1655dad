#pragma once

#include <cstdint>
#include <optional>

#include "scree/config/settings.hpp"
#include "scree/core/seen_cloud.hpp"
#include "scree/core/stage_times.hpp"
#include "scree/detect/beam_grid.hpp"
#include "scree/detect/body_regions.hpp"
#include "scree/detect/candidate_points.hpp"
#include "scree/detect/cluster_context.hpp"
#include "scree/detect/clusters.hpp"
#include "scree/detect/elevation_gradient.hpp"
#include "scree/detect/euclidean_clusters.hpp"
#include "scree/detect/gradient_raster.hpp"
#include "scree/detect/ground_edges.hpp"
#include "scree/detect/ground_surface.hpp"
#include "scree/detect/hole_evidence.hpp"
#include "scree/detect/stage_counts.hpp"

namespace scree {

GroundSurfaceSettings ground_surface_of(const SurfaceSettings& settings);

/// Our method: the ground's surface is spanned under rocks and over holes, what stands above it or
/// lies below it is clustered, and the network is told all features. Memory is taken once, here.
class SurfaceMethod {
public:
  /// @param clearance metres above the ground up to which beams count; 0: any height
  SurfaceMethod(const SurfaceSettings& settings, double clearance, const DetectorLimits& limits);

  /// Metres from the origin within which its cells can be told apart.
  float reach() const;

  /// @param points thinned; finite, within reach(), no more of them than the limits say
  /// @param cloud that they come from
  ClusteredPoints find(const PointCloud& points, const SeenCloud& cloud, StageCounts& counts,
                       StageTimer& timer);

  // What each stage of the last call gave.
  const GroundSurface& ground() const { return surface_; }
  const CandidatePoints& candidates() const { return candidates_; }
  ClusteredPoints result() const { return {kept_, clusters_}; }
  /// Where the ground ends or steps.
  const GroundEdges& edges() const { return edges_; }

private:
  void build_ground(const PointCloud& points, const SeenCloud& cloud);
  void mark_points_off_ground(const PointCloud& points);
  bool is_candidate(std::size_t i) const { return roles_[i] == GradientRaster::Role::asks; }
  void thin_candidates(StageCounts& counts);
  void gather_candidates(const PointCloud& points, StageCounts& counts);
  void cluster(StageCounts& counts);
  void measure_clusters(const PointCloud& points);
  template <class Condition>
  float share_of(const Cluster& cluster, const Condition& condition) const;
  bool is_terrace(const Cluster& cluster) const;
  bool is_open_pit(const Cluster& cluster) const;
  bool is_crater(const Cluster& cluster) const;

  SurfaceSettings settings_;
  float highest_;  // metres above the ground
  std::size_t max_candidates_;
  ElevationGradient kernel_;

  GradientRaster gradient_;
  GroundSurface surface_;
  BeamGrid beam_grid_;
  FixedVector<float> height_;                // above the surface, of each point
  FixedVector<GradientRaster::Role> roles_;  // of each of them; candidates ask
  CandidatePoints candidates_, kept_;
  EuclideanClusters euclidean_;
  PointCloud split_;  // for Euclidean clustering
  std::optional<BodyRegions> regions_;
  Clusters clusters_;
  ClusterContext context_;
  HoleEvidence evidence_;
  GroundEdges edges_;
};

}  // namespace scree
