#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/pose.hpp"

namespace scree {

enum class ObstacleKind : std::uint8_t { positive, negative };

constexpr const char* name(ObstacleKind kind) {
  return kind == ObstacleKind::positive ? "positive" : "negative";
}

/// Something that a wheel must not meet: a rock (positive) or a hole (negative).
struct Obstacle {
  std::int64_t id = 0;
  ObstacleKind kind = ObstacleKind::positive;
  float confidence = 0;                              ///< 0..1
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of the box, metres
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();  ///< length, width, height of the box, metres
  double yaw = 0;     ///< of the box's length about z, radians, in (-pi/2, pi/2]
  double height = 0;  ///< above the surrounding ground; below zero: depth, metres
  std::uint32_t points = 0;
};

/// What was found in one cloud, and where the robot was.
struct ObstacleList {
  std::int64_t stamp_ns = 0;        ///< of the data, not of publishing
  Pose pose;                        ///< `base` in `odom` at stamp_ns
  FixedVector<Obstacle> obstacles;  ///< in `odom`

  ObstacleList() = default;
  explicit ObstacleList(std::size_t capacity) : obstacles(capacity) {}
};

}  // namespace scree
