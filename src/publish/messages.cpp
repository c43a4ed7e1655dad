#include "scree/publish/messages.hpp"

#include <algorithm>

namespace scree {
namespace {

void to_array(const Eigen::Vector3d& vector, double (&array)[3]) {
  std::copy_n(vector.data(), 3, array);
}

Eigen::Vector3d to_vector(const double (&array)[3]) {
  return {array[0], array[1], array[2]};
}

}  // namespace

void to_message(const ObstacleList& list, obstacle_list_t& message) {
  message.stamp_ns = list.stamp_ns;
  to_array(list.pose.translation, message.p);
  const Eigen::Quaterniond& q = list.pose.rotation;
  message.q[0] = q.w();
  message.q[1] = q.x();
  message.q[2] = q.y();
  message.q[3] = q.z();
  message.size = static_cast<std::int32_t>(list.obstacles.size());
  message.obstacles.resize(list.obstacles.size());
  for (std::size_t i = 0; i < list.obstacles.size(); ++i) {
    const Obstacle& from = list.obstacles[i];
    obstacle_t& to = message.obstacles[i];
    to.id = from.id;
    to.kind = from.kind == ObstacleKind::positive ? obstacle_t::POSITIVE : obstacle_t::NEGATIVE;
    to.confidence = from.confidence;
    to_array(from.center, to.center);
    to_array(from.extent, to.extent);
    to.yaw = from.yaw;
    to.height = from.height;
    to.points = static_cast<std::int32_t>(from.points);
  }
}

void from_message(const obstacle_list_t& message, ObstacleList& list) {
  list.stamp_ns = message.stamp_ns;
  list.pose.translation = to_vector(message.p);
  list.pose.rotation = {message.q[0], message.q[1], message.q[2], message.q[3]};
  if (list.obstacles.capacity() < message.obstacles.size()) {
    list.obstacles = FixedVector<Obstacle>(message.obstacles.size());
  }
  list.obstacles.clear();
  for (const obstacle_t& from : message.obstacles) {
    Obstacle to;
    to.id = from.id;
    to.kind = from.kind > 0 ? ObstacleKind::positive : ObstacleKind::negative;
    to.confidence = from.confidence;
    to.center = to_vector(from.center);
    to.extent = to_vector(from.extent);
    to.yaw = from.yaw;
    to.height = from.height;
    to.points = static_cast<std::uint32_t>(from.points);
    list.obstacles.push_back(to);
  }
}

}  // namespace scree
