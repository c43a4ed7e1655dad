#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "scree/core/point_cloud.hpp"

namespace scree::test {

/// Eq. 3-4 at one position; nothing where fewer than `least` points lie within r.
inline std::optional<double> kernel_estimate(const PointCloud& cloud, double x, double y, double r,
                                             double bandwidth, int least) {
  double weights = 0, sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double dx = cloud.x[i] - x, dy = cloud.y[i] - y;
    if (dx * dx + dy * dy > r * r) continue;
    const double k = 0.6171 * std::exp(-0.5 * std::pow(dx / bandwidth, 2)) *
                     std::exp(-0.5 * std::pow(dy / bandwidth, 2));
    weights += k;
    sum += k * cloud.z[i];
    ++count;
  }
  if (count < least) return std::nullopt;
  return sum / weights;
}

struct KernelOfFormula {
  double d, r, bandwidth;
  int least;
};

/// Eq. 1-4 at a place, written out plainly; nothing where one of the eight positions is not known.
inline std::optional<Eigen::Vector2d> slope_by_formula(const PointCloud& cloud, double x, double y,
                                                       const KernelOfFormula& kernel) {
  std::array<std::array<double, 3>, 3> z{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      if (row == 1 && column == 1) continue;
      const auto estimate = kernel_estimate(cloud, x + (double(column) - 1) * kernel.d,
                                            y + (double(row) - 1) * kernel.d, kernel.r,
                                            kernel.bandwidth, kernel.least);
      if (!estimate) return std::nullopt;
      z[row][column] = *estimate;
    }
  }
  return Eigen::Vector2d(z[0][2] + 2 * z[1][2] + z[2][2] - z[0][0] - 2 * z[1][0] - z[2][0],
                         z[2][0] + 2 * z[2][1] + z[2][2] - z[0][0] - 2 * z[0][1] - z[0][2]) /
         (8 * kernel.d);
}

inline bool is_slope(float x, float y, const Eigen::Vector2d& expected) {
  return std::abs(x - expected.x()) <= 1e-4 && std::abs(y - expected.y()) <= 1e-4;
}

}  // namespace scree::test
