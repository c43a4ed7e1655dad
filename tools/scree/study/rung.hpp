#pragma once

#include "scree/config/settings.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/detect/beam_grid.hpp"
#include "scree/detect/cluster_context.hpp"
#include "scree/detect/clusters.hpp"
#include "scree/detect/euclidean_clusters.hpp"
#include "scree/detect/ground_surface.hpp"
#include "scree/detect/overhangs.hpp"
#include "scree/detect/sloped_cloud.hpp"
#include "scree/detect/supervoxels.hpp"
#include "scree/detect/voxel_grid.hpp"

namespace scree::cli {

/// A step between the paper's method and ours, for clouds: the paper's super-voxels with heights
/// above the ground's surface. Its clusters are made of steep points, or of those off the ground.
class SurfaceRung {
public:
  enum class Candidates { steep, off_ground };

  /// @param settings both methods' count: the gradient, edges and super-voxels are the paper's
  SurfaceRung(const DetectSettings& settings, const DetectorLimits& limits, Candidates candidates);

  /// @return valid until the next call
  ClusteredPoints find(PointView cloud);

private:
  void take_in(PointView cloud);
  void gather_candidates();
  void cluster();
  void measure_clusters();

  DetectSettings settings_;
  Candidates chosen_;
  ElevationGradient gradient_;
  VoxelGrid voxel_grid_;
  PointCloud points_;
  Overhangs overhangs_;
  SlopedCloud sloped_;
  GroundSurface surface_;
  BeamGrid beam_grid_;
  CandidatePoints candidates_, kept_, split_;
  Supervoxels supervoxels_;
  EuclideanClusters euclidean_;
  FixedVector<std::uint32_t> labels_;
  Clusters clusters_;
  ClusterContext context_;
};

}  // namespace scree::cli
