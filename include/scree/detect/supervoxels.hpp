#pragma once

#include <cstdint>
#include <span>

#include "scree/detect/candidate_points.hpp"
#include "scree/detect/space_cells.hpp"

namespace scree {

/// Weights and lengths of the metric D = sqrt(wc Dc^2 + ws Ds^2 / (3 Rseed^2) + wn Dn^2).
struct SupervoxelSettings {
  float voxel_size;           ///< edge of a voxel, metres
  float seed_distance;        ///< Rseed, metres
  float reflectivity_weight;  ///< wc; Dc is the difference of reflectivity, scaled to 0..1
  float spatial_weight;       ///< ws; Ds is the distance, metres
  float normal_weight;        ///< wn; Dn is 1 - |cosine| of the angle between the normals
};

/// Voxel cloud connectivity segmentation (paper algorithm 2; Papon et al., CVPR 2013): edge points
/// are put into voxels, seeds stand on a grid of Rseed, and blocks grow through adjacent voxels,
/// each voxel going to the block whose mean it is nearest to by D.
class Supervoxels {
public:
  explicit Supervoxels(std::size_t max_points);

  /// @pre edges.size() <= max_points, points finite and within
  /// reach_of_cells(voxel_size, max_points, 3)
  void segment(const CandidatePoints& edges, const SupervoxelSettings& settings);

  /// Block of each edge point, or kNoLabel: unreached by every seed, or in a removed block.
  std::span<const std::uint32_t> labels() const { return labels_; }
  std::size_t blocks() const { return centers_.size(); }
  /// Centre of gravity of each block's points; reflectivity is the mean.
  const PointCloud& centers() const { return centers_; }
  std::span<const std::uint32_t> block_points() const { return block_points_; }

  /// Removes blocks with fewer points and numbers the others anew.
  void remove_small(std::uint32_t min_points);

private:
  /// What a voxel, or the mean of a block, is compared by. Metres; reflectivity 0..1; unit normal.
  struct Profile {
    float x = 0, y = 0, z = 0, reflectivity = 0;
    float normal_x = 0, normal_y = 0, normal_z = 0;

    void add(const Profile& other);
    /// From a sum of `count` profiles to their mean.
    void average(std::uint32_t count);
  };

  void fill_voxels(const CandidatePoints& edges, float voxel_size);
  void find_neighbours();
  void place_seeds(const SupervoxelSettings& settings);
  void grow(const SupervoxelSettings& settings);
  void average_blocks();
  void label_points(const CandidatePoints& edges);
  static float squared_metric(const Profile& a, const Profile& b,
                              const SupervoxelSettings& settings);

  static constexpr std::size_t kNeighbours = 26;

  SpaceCells point_cells_;                 // edge points in voxels
  FixedVector<Profile> voxels_;            // mean of the points in each
  PointCloud voxel_centers_;               // the same, for the seed grid
  SpaceCells seed_cells_;                  // voxels in cells of the seed grid
  FixedVector<std::uint32_t> voxel_of_;    // of each edge point
  FixedVector<std::uint32_t> neighbours_;  // kNeighbours for each voxel, kNoLabel where none
  FixedVector<Profile> block_means_;
  FixedVector<std::uint32_t> block_voxels_;        // their count
  FixedVector<std::uint32_t> owner_, next_owner_;  // block of each voxel
  FixedVector<float> distance_;                    // squared metric of each voxel to its owner
  FixedVector<std::uint32_t> new_label_;

  PointCloud centers_;
  FixedVector<std::uint32_t> labels_, block_points_;
};

}  // namespace scree
