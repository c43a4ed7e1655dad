#pragma once

#include "scree/detect/candidate_points.hpp"

namespace scree {

/// Writes the points in the plane, those above the ground at z = gap and the others at -gap, so
/// that a hole and the rock on its rim never grow together.
/// @param gap metres, more than half of what a cluster bridges
inline void split_by_sign(const CandidatePoints& points, float gap, PointCloud& split) {
  split.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    split.push_back(points.points.x[i], points.points.y[i], points.height[i] > 0 ? gap : -gap,
                    points.points.reflectivity[i]);
  }
}

}  // namespace scree
