#include "scree/detect/oriented_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scree/detect/multiversion.hpp"

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

constexpr int kLanes = 8;
using Lanes = float __attribute__((vector_size(4 * kLanes)));

/// Directions a degree apart, one a lane.
struct Directions {
  Lanes angle, cosine, sine;  ///< rad

  static Directions from_degrees(int first) {
    Directions directions;
    for (int k = 0; k < kLanes; ++k) {
      directions.angle[k] = static_cast<float>(first + k) * kPi / 180.0F;
      directions.cosine[k] = std::cos(directions.angle[k]);
      directions.sine[k] = std::sin(directions.angle[k]);
    }
    return directions;
  }
};

/// How far points reach along each direction (u) and across it (v), from the first of them.
struct Extents {
  Lanes low_u, high_u, low_v, high_v;
};

SCREE_MULTIVERSION
Extents extents_along(const Directions& directions, const PointView& points,
                      std::span<const std::uint32_t> indices) {
  const Lanes c = directions.cosine, s = directions.sine;
  const float origin_x = points.x[indices[0]], origin_y = points.y[indices[0]];
  Lanes low_u{}, high_u{}, low_v{}, high_v{};
  for (const std::uint32_t i : indices) {
    const float x = points.x[i] - origin_x, y = points.y[i] - origin_y;
    const Lanes u = x * c + y * s, v = y * c - x * s;
    low_u = u < low_u ? u : low_u;
    high_u = u > high_u ? u : high_u;
    low_v = v < low_v ? v : low_v;
    high_v = v > high_v ? v : high_v;
  }
  return {low_u, high_u, low_v, high_v};
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
  for (int step = 0; step < 90; step += kLanes) {
    const Directions directions = Directions::from_degrees(step);
    const Extents extents = extents_along(directions, points, indices);
    for (int k = 0; k < kLanes && step + k < 90; ++k) {
      const float along = extents.high_u[k] - extents.low_u[k];
      const float across = extents.high_v[k] - extents.low_v[k];
      if (along * across >= best_area) continue;
      best_area = along * across;
      const float u = (extents.low_u[k] + extents.high_u[k]) / 2;
      const float v = (extents.low_v[k] + extents.high_v[k]) / 2;
      const float c = directions.cosine[k], s = directions.sine[k];
      best = {origin_x + u * c - v * s, origin_y + u * s + v * c, along, across,
              directions.angle[k]};
    }
  }
  order_sides(best);
  return best;
}

}  // namespace scree
