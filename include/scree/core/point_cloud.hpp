#pragma once

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
  /// False when full; the point is then not taken.
  bool push_back(float px, float py, float pz, float preflectivity) {
    return x.push_back(px) && y.push_back(py) && z.push_back(pz) &&
           reflectivity.push_back(preflectivity);
  }
  operator PointView() const { return {x, y, z, reflectivity}; }
};

}  // namespace scree
