#pragma once

#include <cstdint>
#include <optional>

#include "scree/config/settings.hpp"
#include "scree/core/seen_cloud.hpp"
#include "scree/core/stage_times.hpp"
#include "scree/detect/beam_sectors.hpp"
#include "scree/detect/candidate_points.hpp"
#include "scree/detect/clusters.hpp"
#include "scree/detect/ground_height.hpp"
#include "scree/detect/kd_tree_clusters.hpp"
#include "scree/detect/sloped_cloud.hpp"
#include "scree/detect/stage_counts.hpp"
#include "scree/detect/supervoxels.hpp"
#include "scree/detect/suppression.hpp"

namespace scree {

SupervoxelSettings supervoxels_of(const EdgeSettings& settings);

/// The paper's method: points on steep ground, thinned by non-maximum suppression, in Euclidean
/// clusters of their super-voxels (algorithm 2) or of themselves (algorithm 1), with heights above
/// a ring around each cluster and the features F1-F5. Memory is taken once, here.
class EdgeMethod {
public:
  EdgeMethod(const EdgeSettings& settings, const DetectorLimits& limits);

  /// Metres from the origin within which its cells can be told apart.
  float reach() const;

  /// @pre finite points within reach(), no more of them than the limits say
  /// @param cloud that they come from
  ClusteredPoints find(const PointCloud& points, const SeenCloud& cloud, StageCounts& counts,
                       StageTimer& timer);

  // What each stage of the last call gave.
  const SlopedCloud& sloped() const { return sloped_; }
  const CandidatePoints& candidates() const { return edges_; }
  ClusteredPoints result() const { return {suppression_ ? kept_ : edges_, clusters_}; }
  /// Null without super-voxels.
  const Supervoxels* supervoxels() const { return supervoxels_ ? &*supervoxels_ : nullptr; }

private:
  void select_edges(StageCounts& counts);
  void cluster(const CandidatePoints& edges, StageCounts& counts, StageTimer& timer);
  void grow_supervoxels(const CandidatePoints& edges, StageCounts& counts);
  void measure_clusters(CandidatePoints& edges, bool knows_beams);

  EdgeSettings settings_;
  std::size_t max_points_, max_edges_;
  ElevationGradient gradient_;
  std::optional<Suppression> suppression_;

  SlopedCloud sloped_;
  FixedVector<std::uint8_t> is_edge_;  // for each sorted point
  CandidatePoints edges_, kept_;
  PlaneCells edge_cells_;
  std::optional<Supervoxels> supervoxels_;
  KdTreeClusters euclidean_;
  FixedVector<std::uint32_t> labels_;  // cluster of each edge point
  Clusters clusters_;
  GroundHeight ground_;
  BeamSectors sectors_;
};

}  // namespace scree
