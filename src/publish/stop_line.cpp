#include "scree/publish/stop_line.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace scree {

bool is_in_zone(const StopSettings& zone, const Pose& pose, const Obstacle& obstacle) {
  const Pose to_base = pose.inverse();
  ConvexPolygon outline = outline_of(obstacle);
  for (Eigen::Vector2d& corner : outline) {
    const Eigen::Vector3d place(corner.x(), corner.y(), obstacle.center.z());
    corner = (to_base * place).head<2>() - Eigen::Vector2d(zone.length / 2, 0);
  }
  const Eigen::Vector2d zone_half(zone.length / 2, zone.width / 2);
  // Two convex polygons are apart when they are apart across a side of one of them.
  for (const auto& [x, y] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    const Eigen::Vector2d outwards(x, y);
    const double reach = zone_half.dot(outwards.cwiseAbs());
    const auto is_beyond = [&](const Eigen::Vector2d& corner) {
      return outwards.dot(corner) > reach;
    };
    if (std::ranges::all_of(outline, is_beyond)) return false;
  }
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d side = outline[(i + 1) % outline.size()] - outline[i];
    const Eigen::Vector2d inwards(-side.y(), side.x());
    if (inwards.dot(outline[i]) > zone_half.dot(inwards.cwiseAbs())) return false;
  }
  return true;
}

bool will_be_in_zone(const StopSettings& zone, const Pose& pose, const Obstacle& obstacle) {
  constexpr int kSteps = 8;
  const Eigen::Vector3d velocity(obstacle.velocity.x(), obstacle.velocity.y(), 0);
  if (velocity.isZero()) return is_in_zone(zone, pose, obstacle);
  for (int i = 0; i <= kSteps; ++i) {
    Obstacle then = obstacle;
    move_into_parent({i * zone.hold / kSteps * velocity, Eigen::Quaterniond::Identity()}, then);
    if (is_in_zone(zone, pose, then)) return true;
  }
  return false;
}

void StopLine::update(const ObstacleList& list, std::int64_t now_ns) {
  hold(now_ns);
  is_obstructed_ = std::any_of(
      list.obstacles.begin(), list.obstacles.end(),
      [&](const Obstacle& obstacle) { return will_be_in_zone(settings_, list.pose, obstacle); });
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
