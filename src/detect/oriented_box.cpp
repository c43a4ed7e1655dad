#include "scree/detect/oriented_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace scree {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// Makes the longer side the length.
void order_sides(OrientedBox& box) {
  if (box.length >= box.width) return;
  std::swap(box.length, box.width);
  // At most pi/2, though the nearest float lies above it.
  box.yaw = box.yaw > 0 ? box.yaw - kPi / 2 : std::nextafter(kPi / 2, 0.0F);
}

}  // namespace

OrientedBox box_along(float yaw, PointView points, std::span<const std::uint32_t> indices) {
  const float origin_x = points.x[indices[0]], origin_y = points.y[indices[0]];
  const float c = std::cos(yaw), s = std::sin(yaw);
  float low_u = 0, high_u = 0, low_v = 0, high_v = 0;
  for (const std::uint32_t i : indices) {
    const float x = points.x[i] - origin_x, y = points.y[i] - origin_y;
    const float u = x * c + y * s, v = y * c - x * s;
    low_u = std::min(low_u, u);
    high_u = std::max(high_u, u);
    low_v = std::min(low_v, v);
    high_v = std::max(high_v, v);
  }
  const float u = (low_u + high_u) / 2, v = (low_v + high_v) / 2;
  OrientedBox box{origin_x + u * c - v * s, origin_y + u * s + v * c, high_u - low_u,
                  high_v - low_v, yaw};
  order_sides(box);
  return box;
}

OrientedBox smallest_box(PointView points, std::span<const std::uint32_t> indices) {
  const float origin_x = points.x[indices[0]], origin_y = points.y[indices[0]];
  OrientedBox best;
  float best_area = std::numeric_limits<float>::max();
  for (int step = 0; step < 90; ++step) {
    const float angle = static_cast<float>(step) * kPi / 180.0F;
    const float c = std::cos(angle), s = std::sin(angle);
    float low_u = 0, high_u = 0, low_v = 0, high_v = 0;
    for (const std::uint32_t i : indices) {
      const float x = points.x[i] - origin_x, y = points.y[i] - origin_y;
      const float u = x * c + y * s, v = y * c - x * s;
      low_u = std::min(low_u, u);
      high_u = std::max(high_u, u);
      low_v = std::min(low_v, v);
      high_v = std::max(high_v, v);
    }
    const float along = high_u - low_u, across = high_v - low_v;
    if (along * across >= best_area) continue;
    best_area = along * across;
    const float u = (low_u + high_u) / 2, v = (low_v + high_v) / 2;
    best = {origin_x + u * c - v * s, origin_y + u * s + v * c, along, across, angle};
  }
  order_sides(best);
  return best;
}

}  // namespace scree
