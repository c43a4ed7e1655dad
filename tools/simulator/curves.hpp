#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {

inline constexpr double kTurn = 2 * std::numbers::pi;  ///< radians

inline Eigen::Vector2d unit_vector(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

/// 0 up to `from`, 1 from `to` on, with no bend at either.
inline double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace scree
