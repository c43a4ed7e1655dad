#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "scree/core/convex_polygon.hpp"
#include "scree/core/fixed_vector.hpp"
#include "scree/core/pose.hpp"

namespace scree {

enum class ObstacleKind : std::uint8_t { positive, negative };

constexpr const char* name(ObstacleKind kind) {
  return kind == ObstacleKind::positive ? "positive" : "negative";
}

/// What says that there is a negative obstacle, or an edge.
enum class Evidence : std::uint8_t {
  none,    ///< of a positive obstacle that is no edge: it was seen itself
  inside,  ///< beams went into it
  wall,    ///< only its far wall was seen
  edge,    ///< the ground ends or steps
  shadow   ///< nothing came back where ground was due
};

/// By Evidence.
inline constexpr std::array<const char*, 5> kEvidenceNames = {"none", "inside", "wall", "edge",
                                                              "shadow"};

constexpr const char* name(Evidence evidence) {
  return kEvidenceNames[static_cast<std::size_t>(evidence)];
}

/// Something that a wheel must not meet: a rock or a person (positive), or a hole (negative).
struct Obstacle {
  std::int64_t id = 0;
  ObstacleKind kind = ObstacleKind::positive;
  float confidence = 0;                              ///< 0..1
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of the box, metres
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();  ///< length, width, height of the box, metres
  double yaw = 0;     ///< of the box's length about z, radians, in (-pi/2, pi/2]
  double height = 0;  ///< above the surrounding ground; below zero: depth, metres
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< x, y, m/s; zero: it stands
  std::uint32_t points = 0;
  Evidence evidence = Evidence::none;
  ConvexPolygon footprint;  ///< around its points, seen from above; empty: the box stands for it
};

/// The footprint where it is known, else the box seen from above; in the frame of the obstacle.
inline ConvexPolygon outline_of(const Obstacle& obstacle) {
  if (obstacle.footprint.has_area()) return obstacle.footprint;
  const Eigen::Vector2d along(std::cos(obstacle.yaw), std::sin(obstacle.yaw));
  const Eigen::Vector2d length = obstacle.extent.x() / 2 * along;
  const Eigen::Vector2d width = obstacle.extent.y() / 2 * Eigen::Vector2d(-along.y(), along.x());
  const Eigen::Vector2d middle = obstacle.center.head<2>();
  ConvexPolygon box;
  box.push_back(middle + length - width);
  box.push_back(middle + length + width);
  box.push_back(middle - length + width);
  box.push_back(middle - length - width);
  return box;
}

/// Brings centre, velocity and footprint from a child frame into its parent, the footprint at the
/// height of the centre. The yaw stays.
inline void move_into_parent(const Pose& child, Obstacle& obstacle) {
  const double z = obstacle.center.z();
  const Eigen::Vector2d velocity = obstacle.velocity;
  obstacle.velocity = (child.rotation * Eigen::Vector3d(velocity.x(), velocity.y(), 0)).head<2>();
  for (Eigen::Vector2d& corner : obstacle.footprint) {
    corner = (child * Eigen::Vector3d(corner.x(), corner.y(), z)).head<2>();
  }
  obstacle.center = child * obstacle.center;
}

/// What was found in one cloud, and where the robot was.
struct ObstacleList {
  std::int64_t stamp_ns = 0;        ///< of the data, not of publishing
  Pose pose;                        ///< `base` in `odom` at stamp_ns
  FixedVector<Obstacle> obstacles;  ///< in `odom`

  ObstacleList() = default;
  explicit ObstacleList(std::size_t capacity) : obstacles(capacity) {}
};

}  // namespace scree
