#include "scree/publish/stop_line.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace scree {

bool is_in_zone(const StopSettings& zone, const Pose& pose, const Obstacle& obstacle) {
  const Pose to_base = pose.inverse();
  const Eigen::Vector3d center = to_base * obstacle.center;
  const Eigen::Vector3d length =
      to_base.rotation * Eigen::Vector3d(std::cos(obstacle.yaw), std::sin(obstacle.yaw), 0);
  const Eigen::Vector2d along = length.head<2>().normalized(), across(-along.y(), along.x());
  const Eigen::Vector2d zone_half(zone.length / 2, zone.width / 2);
  const Eigen::Vector2d between = center.head<2>() - Eigen::Vector2d(zone.length / 2, 0);
  // Two rectangles are apart when they are apart along a side of one of them.
  const auto are_apart_along = [&](const Eigen::Vector2d& axis) {
    const double zone_reach = zone_half.dot(axis.cwiseAbs());
    const double box_reach = obstacle.extent.x() / 2 * std::abs(along.dot(axis)) +
                             obstacle.extent.y() / 2 * std::abs(across.dot(axis));
    return std::abs(between.dot(axis)) > zone_reach + box_reach;
  };
  return !are_apart_along(Eigen::Vector2d::UnitX()) && !are_apart_along(Eigen::Vector2d::UnitY()) &&
         !are_apart_along(along) && !are_apart_along(across);
}

void StopLine::update(const ObstacleList& list, std::int64_t now_ns) {
  hold(now_ns);
  is_obstructed_ = std::any_of(
      list.obstacles.begin(), list.obstacles.end(),
      [&](const Obstacle& obstacle) { return is_in_zone(settings_, list.pose, obstacle); });
}

void StopLine::set_blind(bool is_blind, std::int64_t now_ns) {
  hold(now_ns);
  is_blind_ = is_blind;
}

void StopLine::hold(std::int64_t now_ns) {
  if (!is_blind_ && !is_obstructed_) return;
  was_on_ = true;
  last_reason_ns_ = now_ns;
}

bool StopLine::is_on(std::int64_t now_ns) const {
  if (is_blind_ || is_obstructed_) return true;
  return was_on_ && static_cast<double>(now_ns - last_reason_ns_) * 1e-9 < settings_.hold;
}

}  // namespace scree
