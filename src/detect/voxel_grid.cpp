#include "scree/detect/voxel_grid.hpp"

#include <algorithm>
#include <cmath>

#include "scree/detect/cell.hpp"

namespace scree {

VoxelGrid::VoxelGrid(std::size_t max_points) : sort_(max_points) {}

namespace {

/// False for what is not finite, too.
bool inside(PointView cloud, std::size_t i, float limit) {
  return std::abs(cloud.x[i]) < limit && std::abs(cloud.y[i]) < limit &&
         std::abs(cloud.z[i]) < limit;
}

}  // namespace

Intake VoxelGrid::filter(PointView cloud, float leaf_size, float limit, PointCloud& out) {
  const std::size_t taken = std::min(cloud.size(), out.capacity());
  const float inverse = 1.0F / leaf_size;
  CellRange columns, rows, layers;
  for (std::size_t i = 0; i < taken; ++i) {
    if (!inside(cloud, i, limit)) continue;
    columns.include(floor_to_cell(cloud.x[i] * inverse));
    rows.include(floor_to_cell(cloud.y[i] * inverse));
    layers.include(floor_to_cell(cloud.z[i] * inverse));
  }

  sort_.clear();
  for (std::size_t i = 0; i < taken; ++i) {
    if (!inside(cloud, i, limit)) continue;
    const std::uint64_t column = columns.offset(floor_to_cell(cloud.x[i] * inverse));
    const std::uint64_t row = rows.offset(floor_to_cell(cloud.y[i] * inverse));
    const std::uint64_t layer = layers.offset(floor_to_cell(cloud.z[i] * inverse));
    sort_.push((row * columns.count() + column) * layers.count() + layer, i);
  }
  sort_.sort();

  out.clear();
  for (std::size_t i = 0; i < sort_.size();) {
    const std::uint64_t key = sort_.key(i);
    double x = 0, y = 0, z = 0, reflectivity = 0;
    const std::size_t first = i;
    for (; i < sort_.size() && sort_.key(i) == key; ++i) {
      const std::size_t point = sort_.index(i);
      x += cloud.x[point];
      y += cloud.y[point];
      z += cloud.z[point];
      reflectivity += cloud.reflectivity[point];
    }
    const double share = 1.0 / static_cast<double>(i - first);
    out.push_back(static_cast<float>(x * share), static_cast<float>(y * share),
                  static_cast<float>(z * share), static_cast<float>(reflectivity * share));
  }
  return {.dropped = cloud.size() - taken, .refused = taken - sort_.size()};
}

Intake copy_finite(PointView cloud, float limit, PointCloud& out) {
  const std::size_t taken = std::min(cloud.size(), out.capacity());
  out.clear();
  for (std::size_t i = 0; i < taken; ++i) {
    if (inside(cloud, i, limit)) {
      out.push_back(cloud.x[i], cloud.y[i], cloud.z[i], cloud.reflectivity[i]);
    }
  }
  return {.dropped = cloud.size() - taken, .refused = taken - out.size()};
}

}  // namespace scree
