#pragma once

#include <Eigen/Core>
#include <array>

#include "scree/core/random.hpp"
#include "simulator/footprint.hpp"

namespace scree {

/// A boulder of a field of them, half sunk into the ground: a dome over an uneven oval.
///
/// Its proportions are those of 25 rocks scanned by lidar (POLAR-Sim, TerrainMeshes, CC0), measured
/// above the plane of the ground around them: width over length 0.76 with a standard deviation of
/// 0.11; height over the root of length and width 0.45 and 0.15; height over the distance r from
/// the middle, 1 on the outline, (1 - r^q)^s with q 1.35 (0.6-2.4) and s 0.50 (0.39-0.65), and
/// about it unevenness of 0.14 of the height; outline uneven by 0.08.
class Boulder {
public:
  /// @param length of the longer side, metres
  static Boulder draw(const Eigen::Vector2d& center, double length, Random& random);

  const Eigen::Vector2d& center() const { return center_; }
  /// Without the unevenness, metres.
  double height() const { return height_; }
  /// It covers nothing further from its centre, metres.
  double reach() const { return reach_; }
  /// Square metres.
  double area() const;
  /// Height over the ground there, metres; 0 beside it.
  /// @param unevenness of the place, with a standard deviation of about 0.25
  double top(const Eigen::Vector2d& place, double unevenness) const;
  Footprint footprint() const;

private:
  double outline(double angle) const;

  Eigen::Vector2d center_{0, 0}, half_{0.5, 0.4}, axis_{1, 0};
  double height_ = 0.4, reach_ = 0.5, roundness_ = 1.35, steepness_ = 0.5;
  std::array<double, 3> wave_{}, phase_{};  // of two to four waves around the outline
};

/// Length of a boulder of a field where their number falls with its power of the length (Pareto's
/// distribution), metres.
double draw_boulder_length(double shortest, double longest, double power, Random& random);

}  // namespace scree
