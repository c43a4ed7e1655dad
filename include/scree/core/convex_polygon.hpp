#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace scree {

/// A convex polygon in the horizontal plane: up to 16 corners, counter-clockwise seen from above,
/// not closed, metres. Its memory is fixed. With less than three corners it has no area.
class ConvexPolygon {
public:
  static constexpr std::size_t kMaxCorners = 16;

  ConvexPolygon() { corners_.fill(Eigen::Vector2d::Zero()); }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  bool has_area() const { return size_ > 2; }

  Eigen::Vector2d* begin() { return corners_.data(); }
  Eigen::Vector2d* end() { return begin() + size_; }
  const Eigen::Vector2d* begin() const { return corners_.data(); }
  const Eigen::Vector2d* end() const { return begin() + size_; }
  const Eigen::Vector2d& operator[](std::size_t i) const { return corners_[i]; }

  /// False when full; the corner is then not taken.
  bool push_back(const Eigen::Vector2d& corner) {
    if (size_ == kMaxCorners) return false;
    corners_[size_++] = corner;
    return true;
  }
  void clear() { size_ = 0; }

  /// Whether a place lies inside or on the boundary. A polygon without area contains none.
  bool contains(const Eigen::Vector2d& place) const {
    for (std::size_t i = 0; i < size_; ++i) {
      const Eigen::Vector2d& from = corners_[i];
      const Eigen::Vector2d along = corners_[(i + 1) % size_] - from, to = place - from;
      if (along.x() * to.y() - along.y() * to.x() < 0) return false;
    }
    return has_area();
  }

private:
  std::array<Eigen::Vector2d, kMaxCorners> corners_;
  std::size_t size_ = 0;
};

}  // namespace scree
