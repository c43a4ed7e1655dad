#include "scree/detect/voxel_grid.hpp"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

/// A cloud may lack the reflectivity of a point; that is no reason to lose the point.
float known(float reflectivity) {
  return std::isfinite(reflectivity) ? reflectivity : 0.0F;
}

}  // namespace

Intake VoxelGrid::filter(PointView cloud, float leaf_size, float limit, PointCloud& out) {
  const std::size_t taken = std::min(cloud.size(), out.capacity());
  cells_.build(cloud.first(taken), leaf_size, limit);
  out.clear();
  for (std::size_t cell = 0; cell < cells_.cells(); ++cell) {
    const Run run = cells_.run(cell);
    double x = 0, y = 0, z = 0, reflectivity = 0;
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const std::uint32_t point = cells_.source(i);
      x += cloud.x[point];
      y += cloud.y[point];
      z += cloud.z[point];
      reflectivity += known(cloud.reflectivity[point]);
    }
    const double share = 1.0 / (run.end - run.begin);
    out.push_back(static_cast<float>(x * share), static_cast<float>(y * share),
                  static_cast<float>(z * share), static_cast<float>(reflectivity * share));
  }
  return {.dropped = cloud.size() - taken, .refused = taken - cells_.size()};
}

Intake copy_finite(PointView cloud, float limit, PointCloud& out) {
  const std::size_t taken = std::min(cloud.size(), out.capacity());
  out.clear();
  for (std::size_t i = 0; i < taken; ++i) {
    if (std::abs(cloud.x[i]) < limit && std::abs(cloud.y[i]) < limit &&
        std::abs(cloud.z[i]) < limit) {
      out.push_back(cloud.x[i], cloud.y[i], cloud.z[i], known(cloud.reflectivity[i]));
    }
  }
  return {.dropped = cloud.size() - taken, .refused = taken - out.size()};
}

}  // namespace scree
