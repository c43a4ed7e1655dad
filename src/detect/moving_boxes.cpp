#include "scree/detect/moving_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scree/detect/oriented_box.hpp"

namespace scree {

MovingBoxes::MovingBoxes(std::size_t max_points, std::size_t max_obstacles)
    : points_(max_points), order_(max_points), polygons_(max_points), found_(max_obstacles) {}

void MovingBoxes::add(PointView points, std::span<const std::uint32_t> members, const Pose& pose,
                      const GroundAt& ground_at) {
  constexpr float kLeastHeight = 0.05F;  // metres
  points_.clear();
  order_.clear();
  float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
  for (const std::uint32_t i : members) {
    const Eigen::Vector3f point =
        (pose * Eigen::Vector3d(points.x[i], points.y[i], points.z[i])).cast<float>();
    order_.push_back(static_cast<std::uint32_t>(points_.size()));
    points_.push_back(point.x(), point.y(), point.z(), 0);
    low = std::min(low, point.z());
    high = std::max(high, point.z());
  }
  const OrientedBox box = smallest_box(points_, {order_.data(), order_.size()});
  const float ground = ground_at({box.center_x, box.center_y, low});
  if (std::isfinite(ground)) low = ground;
  Obstacle obstacle;
  obstacle.kind = ObstacleKind::positive;
  obstacle.confidence = 1;
  obstacle.height = std::max(high - low, kLeastHeight);
  obstacle.center = {box.center_x, box.center_y, (low + high) / 2};
  obstacle.extent = {box.length, box.width, obstacle.height};
  obstacle.yaw = box.yaw;
  obstacle.points = static_cast<std::uint32_t>(members.size());
  obstacle.footprint = polygons_.around(points_, {order_.data(), order_.size()});
  if (!found_.push_back(obstacle)) ++dropped_;
}

}  // namespace scree
