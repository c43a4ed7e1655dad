#pragma once

#include <cstdint>

#include "scree/config/settings.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/stage_times.hpp"
#include "scree/detect/body_regions.hpp"
#include "scree/detect/clusters.hpp"
#include "scree/detect/edge_points.hpp"
#include "scree/detect/elevation_gradient.hpp"
#include "scree/detect/euclidean_clusters.hpp"
#include "scree/detect/ground_height.hpp"
#include "scree/detect/ground_surface.hpp"
#include "scree/detect/network.hpp"
#include "scree/detect/overhangs.hpp"
#include "scree/detect/plane_cells.hpp"
#include "scree/detect/solidity.hpp"
#include "scree/detect/supervoxels.hpp"
#include "scree/detect/suppression.hpp"
#include "scree/detect/surroundings.hpp"
#include "scree/detect/voxel_grid.hpp"

namespace scree {

/// Points and obstacles at each stage of one call (the paper's chain is 914,608 -> 413,591 ->
/// 82,242
/// -> 26,011), and what did not fit.
struct StageCounts {
  std::size_t input = 0;              ///< points given
  std::size_t dropped = 0;            ///< beyond max_points
  std::size_t refused = 0;            ///< not finite, or too far out for the cells
  std::size_t voxels = 0;             ///< after the voxel grid
  std::size_t below_clearance = 0;    ///< without what the robot passes under
  std::size_t known = 0;              ///< with a gradient
  std::size_t edges = 0;              ///< steeper than the threshold
  std::size_t edges_dropped = 0;      ///< beyond max_edge_points
  std::size_t kept = 0;               ///< after suppression, or without bodies' lone points
  std::size_t blocks = 0;             ///< super-voxels
  std::size_t blocks_kept = 0;        ///< of enough points
  std::size_t clusters = 0;           ///< of enough super-voxels
  std::size_t obstacles = 0;          ///< by the network
  std::size_t obstacles_dropped = 0;  ///< beyond max_obstacles
};

/// What the ground's surface takes of the detector's settings.
GroundSurfaceSettings surface_settings(const DetectSettings& settings);

/// The method of the paper on one point cloud, or ours that grew from it (Candidates). Memory is
/// taken once, here; detect() allocates nothing, and gives the same result for the same cloud.
class Detector {
public:
  Detector(const DetectSettings& settings, Network network);

  /// Finds obstacles in a cloud in a gravity-aligned frame (z up) and writes them, numbered from 1,
  /// in that frame.
  /// @param beams that came to each point of the cloud; empty where nothing is known of them
  /// @param timer started; takes the time of each stage
  void detect(PointView cloud, std::span<const BeamCount> beams, FixedVector<Obstacle>& obstacles,
              StageTimer& timer);
  void detect(PointView cloud, FixedVector<Obstacle>& obstacles) {
    StageTimer none;
    detect(cloud, {}, obstacles, none);
  }

  const StageCounts& counts() const { return counts_; }

  // What each stage of the last call gave.
  const PointCloud& thinned() const { return thinned_; }
  const PlaneCells& cells() const { return cells_; }
  std::span<const float> slope_x() const { return slope_x_; }
  std::span<const float> slope_y() const { return slope_y_; }
  const GroundSurface& surface() const { return surface_; }
  const EdgePoints& edges() const { return edges_; }
  const EdgePoints& kept() const { return thins_edges() ? kept_ : edges_; }
  const Supervoxels& supervoxels() const { return supervoxels_; }
  bool uses_supervoxels() const { return settings_.cluster_method == ClusterMethod::supervoxel; }
  const Clusters& clusters() const { return clusters_; }

private:
  void thin(PointView cloud);
  void build_surface(PointView cloud, std::span<const BeamCount> beams);
  void leave_out_ground_below_edges();
  void choose_candidates();
  void find_edges();
  bool uses_regions() const { return settings_.cluster_method == ClusterMethod::regions; }
  bool thins_edges() const {
    return settings_.suppression || settings_.candidates == Candidates::bodies;
  }
  void thin_edges();
  void keep_company();
  const EdgePoints& parted();
  void grow_supervoxels(const EdgePoints& edges);
  void find_clusters(const EdgePoints& edges);
  void count_members(std::span<const std::uint32_t> labels, std::size_t clusters);
  void measure_clusters();
  void recognise(FixedVector<Obstacle>& obstacles);

  DetectSettings settings_;
  Network network_;
  float limit_;  // metres from the origin within which every stage's cells can be told apart
  StageCounts counts_;

  VoxelGrid voxel_grid_;
  PointCloud thinned_;
  Overhangs overhangs_;
  ElevationGradient gradient_;
  PlaneCells cells_;
  FixedVector<float> slope_x_, slope_y_;  // of the sorted points of cells_
  FixedVector<float> height_;             // of the same, above the surface
  FixedVector<std::uint8_t> is_candidate_, is_edge_;
  EdgePoints edges_, kept_, parted_;
  Suppression suppression_;
  PlaneCells edge_cells_;
  Supervoxels supervoxels_;
  EuclideanClusters euclidean_;
  BodyRegions regions_;
  FixedVector<std::uint32_t> labels_, sizes_;
  Clusters clusters_;
  GroundHeight ground_;
  GroundSurface surface_;
  Solidity solidity_;
  Surroundings surroundings_;
};

}  // namespace scree
