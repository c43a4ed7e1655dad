#include "scree/detect/obstacle_box.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

Eigen::Vector2d in_box_frame(const Obstacle& box, const Eigen::Vector3d& place) {
  const Eigen::Vector2d to = (place - box.center).head<2>();
  const double cosine = std::cos(box.yaw), sine = std::sin(box.yaw);
  return {cosine * to.x() + sine * to.y(), cosine * to.y() - sine * to.x()};
}

std::array<Eigen::Vector3d, 4> corners_of(const Obstacle& box) {
  const Eigen::Vector3d along(std::cos(box.yaw), std::sin(box.yaw), 0);
  const Eigen::Vector3d half_length = box.extent.x() / 2 * along;
  const Eigen::Vector3d half_width = box.extent.y() / 2 * Eigen::Vector3d(-along.y(), along.x(), 0);
  return {box.center + half_length + half_width, box.center + half_length - half_width,
          box.center - half_length + half_width, box.center - half_length - half_width};
}

double distance_to_box(const Obstacle& box, const Eigen::Vector3d& place) {
  const Eigen::Vector2d half = box.extent.head<2>() / 2;
  return (in_box_frame(box, place).cwiseAbs() - half).cwiseMax(0).norm();
}

double distance_between_boxes(const Obstacle& a, const Obstacle& b) {
  double least = std::min(distance_to_box(a, b.center), distance_to_box(b, a.center));
  for (const Eigen::Vector3d& corner : corners_of(b)) {
    least = std::min(least, distance_to_box(a, corner));
  }
  for (const Eigen::Vector3d& corner : corners_of(a)) {
    least = std::min(least, distance_to_box(b, corner));
  }
  return least;
}

}  // namespace scree
