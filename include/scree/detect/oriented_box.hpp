#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "scree/core/point_cloud.hpp"

namespace scree {

/// A rectangle in the horizontal plane, metres and radians.
struct OrientedBox {
  float center_x = 0, center_y = 0;
  float length = 0, width = 0;  ///< length >= width
  float yaw = 0;                ///< direction of the length, in (-pi/2, pi/2]

  /// Returns a function that gives the distance of a position (x, y) from the box in the plane; 0
  /// inside. It serves for many positions: the box's direction is worked out once.
  auto distances() const {
    return [box = *this, c = std::cos(yaw), s = std::sin(yaw)](float x, float y) {
      const float dx = x - box.center_x, dy = y - box.center_y;
      const float along = std::abs(dx * c + dy * s) - box.length / 2;
      const float across = std::abs(dy * c - dx * s) - box.width / 2;
      if (along <= 0 || across <= 0) return std::max({along, across, 0.0F});
      return std::sqrt(along * along + across * across);
    };
  }
};

/// The smallest rectangle around the given points of a cloud, of 90 directions a degree apart.
/// @pre `indices` is not empty
OrientedBox smallest_box(PointView points, std::span<const std::uint32_t> indices);

/// The rectangle around them in one direction, radians.
OrientedBox box_along(float yaw, PointView points, std::span<const std::uint32_t> indices);

}  // namespace scree
