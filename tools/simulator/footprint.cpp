#include "simulator/footprint.hpp"

#include <algorithm>
#include <limits>

namespace scree {

bool contains(const Footprint& footprint, const Eigen::Vector2d& point) {
  bool inside = false;
  for (std::size_t i = 0; i < footprint.size(); ++i) {
    const Eigen::Vector2d& a = footprint[i];
    const Eigen::Vector2d& b = footprint[(i + 1) % footprint.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double crossing = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    inside ^= point.x() < crossing;
  }
  return inside;
}

Footprint hull(std::vector<Eigen::Vector2d> points) {
  std::ranges::sort(points, [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  Footprint corners;
  const auto turns_left = [&](const Eigen::Vector2d& next) {
    const Eigen::Vector2d a = corners.back() - corners[corners.size() - 2];
    const Eigen::Vector2d b = next - corners.back();
    return a.x() * b.y() - a.y() * b.x() > 0;
  };
  // The lower side from left to right, then the upper one back.
  for (const bool is_upper : {false, true}) {
    const std::size_t start = corners.size();
    if (is_upper) std::ranges::reverse(points);
    for (const Eigen::Vector2d& point : points) {
      while (corners.size() > start + 1 && !turns_left(point)) corners.pop_back();
      corners.push_back(point);
    }
    corners.pop_back();
  }
  return corners;
}

double distance(const Footprint& footprint, const Eigen::Vector2d& point) {
  if (contains(footprint, point)) return 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < footprint.size(); ++i) {
    const Eigen::Vector2d& a = footprint[i];
    const Eigen::Vector2d edge = footprint[(i + 1) % footprint.size()] - a;
    const double length = edge.squaredNorm();
    const double along = length > 0 ? std::clamp((point - a).dot(edge) / length, 0.0, 1.0) : 0;
    nearest = std::min(nearest, (point - a - along * edge).norm());
  }
  return nearest;
}

double distance(const Footprint& a, const Footprint& b) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& corner : a) nearest = std::min(nearest, distance(b, corner));
  for (const Eigen::Vector2d& corner : b) nearest = std::min(nearest, distance(a, corner));
  return nearest;
}

}  // namespace scree
