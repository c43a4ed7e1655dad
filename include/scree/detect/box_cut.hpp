#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "scree/core/point_cloud.hpp"
#include "scree/detect/oriented_box.hpp"

namespace scree {

/// A straight line across or along a box, which parts what lies in it in two.
class BoxCut {
public:
  BoxCut() = default;
  /// @param place metres from the middle of the box
  BoxCut(const OrientedBox& box, bool is_across, float place)
      : box_(box),
        cosine_(std::cos(box.yaw)),
        sine_(std::sin(box.yaw)),
        is_across_(is_across),
        place_(place) {}

  /// Whether a position lies in the first part.
  bool has_first(float x, float y) const {
    const float dx = x - box_.center_x, dy = y - box_.center_y;
    return (is_across_ ? dx * cosine_ + dy * sine_ : dy * cosine_ - dx * sine_) < place_;
  }

private:
  OrientedBox box_;
  float cosine_ = 1, sine_ = 0;  // of its direction, worked out once for many positions
  bool is_across_ = true;
  float place_ = 0;
};

struct BestCut {
  BoxCut cut;
  /// Square metres that the boxes of both parts have together; infinite where nothing can be cut.
  float area = std::numeric_limits<float>::infinity();
};

/// The area of a box, square metres, that is at least so wide as anything is.
float area_of(const OrientedBox& box);

/// The cut that leaves the least area: one in the middle, at a third, or where only an arm `strip`
/// metres wide is left.
/// @param indices of the points in the box; they are put in another order
BestCut best_cut(PointView points, std::span<std::uint32_t> indices, const OrientedBox& box,
                 float strip);

}  // namespace scree
