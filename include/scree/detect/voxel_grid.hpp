#pragma once

#include "scree/core/point_cloud.hpp"
#include "scree/detect/space_cells.hpp"

namespace scree {

/// What came of the points that were given to a stage.
struct Intake {
  std::size_t dropped = 0;  ///< points beyond capacity
  std::size_t refused = 0;  ///< points that are not finite, or beyond the range of the cells
};

/// Thins a cloud to the centroid of each occupied voxel (paper fig. 11). Voxels are anchored at the
/// origin, as those of pcl::VoxelGrid are.
class VoxelGrid {
public:
  explicit VoxelGrid(std::size_t max_points) : cells_(max_points) {}

  /// Writes the centroids to `out`, sorted by voxel. Points that are not finite or lie `limit`
  /// metres or more from the origin on an axis are refused.
  /// @pre limit <= reach_of_cells(leaf_size, max_points, 3); out holds max_points
  Intake filter(PointView cloud, float leaf_size, float limit, PointCloud& out);

private:
  SpaceCells cells_;
};

/// Copies the points that VoxelGrid would take, for clouds that are not thinned.
Intake copy_finite(PointView cloud, float limit, PointCloud& out);

}  // namespace scree
