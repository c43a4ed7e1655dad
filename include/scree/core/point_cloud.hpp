#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// Points that somebody else owns, one array a coordinate. Metres; reflectivity 0..255 as Velodyne
/// calibrates it (0..100 diffuse, above that retroreflectors).
struct PointView {
  std::span<const float> x, y, z, reflectivity;

  std::size_t size() const { return x.size(); }
  PointView first(std::size_t count) const { return subview(0, count); }
  PointView subview(std::size_t begin, std::size_t count) const {
    return {x.subspan(begin, count), y.subspan(begin, count), z.subspan(begin, count),
            reflectivity.subspan(begin, count)};
  }
};

/// A point cloud of fixed capacity, one array a coordinate. Units as in PointView.
struct PointCloud {
  FixedVector<float> x, y, z, reflectivity;

  PointCloud() = default;
  explicit PointCloud(std::size_t capacity)
      : x(capacity), y(capacity), z(capacity), reflectivity(capacity) {}

  std::size_t size() const { return x.size(); }
  std::size_t capacity() const { return x.capacity(); }
  bool empty() const { return x.empty(); }

  void clear() { resize(0); }
  /// @pre size <= capacity()
  void resize(std::size_t size) {
    x.resize(size);
    y.resize(size);
    z.resize(size);
    reflectivity.resize(size);
  }
  /// @pre other.size() <= capacity()
  void copy_from(const PointCloud& other) {
    x.copy_from(other.x);
    y.copy_from(other.y);
    z.copy_from(other.z);
    reflectivity.copy_from(other.reflectivity);
  }
  /// False when full; the point is then not taken.
  bool push_back(float px, float py, float pz, float preflectivity) {
    return x.push_back(px) && y.push_back(py) && z.push_back(pz) &&
           reflectivity.push_back(preflectivity);
  }
  operator PointView() const { return {x, y, z, reflectivity}; }
};

/// What points cover of the plane, metres; nothing around the origin where there is none.
struct PlaneBounds {
  float low_x = 0, high_x = 0, low_y = 0, high_y = 0;
};

inline PlaneBounds bounds_of(const PointView& points) {
  if (points.size() == 0) return {};
  PlaneBounds bounds{points.x[0], points.x[0], points.y[0], points.y[0]};
  for (std::size_t i = 1; i < points.size(); ++i) {
    bounds.low_x = std::min(bounds.low_x, points.x[i]);
    bounds.high_x = std::max(bounds.high_x, points.x[i]);
    bounds.low_y = std::min(bounds.low_y, points.y[i]);
    bounds.high_y = std::max(bounds.high_y, points.y[i]);
  }
  return bounds;
}

}  // namespace scree
