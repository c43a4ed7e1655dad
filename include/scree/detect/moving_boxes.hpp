#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/core/pose.hpp"
#include "scree/detect/enclosing_polygon.hpp"

namespace scree {

/// Makes obstacles of the points of a sweep that are on moving things. Memory is taken once.
class MovingBoxes {
public:
  /// z of the ground at a place; no number where it is not known.
  using GroundAt = std::function<float(const Eigen::Vector3d&)>;

  MovingBoxes(std::size_t max_points, std::size_t max_obstacles);

  void clear() { found_.clear(); }
  /// Adds the obstacle around some points, from the ground up to the highest; where the ground is
  /// not known, from the lowest.
  /// @param pose from the frame of the points into that of the obstacles
  /// @pre some finite points, no more than max_points
  void add(PointView points, std::span<const std::uint32_t> members, const Pose& pose,
           const GroundAt& ground_at);
  std::span<const Obstacle> found() const { return {found_.data(), found_.size()}; }
  /// Obstacles that found no room.
  std::uint64_t dropped() const { return dropped_; }

private:
  PointCloud points_;  // of one obstacle
  FixedVector<std::uint32_t> order_;
  EnclosingPolygons polygons_;
  FixedVector<Obstacle> found_;
  std::uint64_t dropped_ = 0;
};

}  // namespace scree
