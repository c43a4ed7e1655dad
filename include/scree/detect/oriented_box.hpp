#pragma once

#include <cstdint>
#include <span>

#include "scree/core/point_cloud.hpp"

namespace scree {

/// A rectangle in the horizontal plane, metres and radians.
struct OrientedBox {
  float center_x = 0, center_y = 0;
  float length = 0, width = 0;  ///< length >= width
  float yaw = 0;                ///< of the length, in (-pi/2, pi/2]

  /// Distance of a position from the box in the plane; 0 inside.
  float distance(float x, float y) const;
};

/// The smallest of the rectangles around the given points of a cloud, among 90 directions a degree
/// apart. @pre `indices` is not empty
OrientedBox smallest_box(PointView points, std::span<const std::uint32_t> indices);

}  // namespace scree
