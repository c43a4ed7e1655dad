#pragma once

#include "scree/core/point_cloud.hpp"

namespace scree {

/// Points of which obstacles may be made, the edge points of the paper or those off the ground's
/// surface, with the slope of the elevation there (metres per metre). The vector
/// (slope_x, slope_y, -1) is the surface normal that points into the ground. Heights are above the
/// ground, in metres, once it is known.
struct CandidatePoints {
  PointCloud points;
  FixedVector<float> slope_x, slope_y, height;

  explicit CandidatePoints(std::size_t capacity)
      : points(capacity), slope_x(capacity), slope_y(capacity), height(capacity) {}

  std::size_t size() const { return points.size(); }
  void clear() {
    points.clear();
    slope_x.clear();
    slope_y.clear();
    height.clear();
  }
  /// False when full; the point is then not taken.
  bool push_back(PointView from, std::size_t i, float along_x, float along_y, float above = 0) {
    return points.push_back(from.x[i], from.y[i], from.z[i], from.reflectivity[i]) &&
           slope_x.push_back(along_x) && slope_y.push_back(along_y) && height.push_back(above);
  }
};

}  // namespace scree
