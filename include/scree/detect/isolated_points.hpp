#pragma once

#include "scree/detect/candidate_points.hpp"
#include "scree/detect/euclidean_clusters.hpp"

namespace scree {

/// Leaves out points without another one within `reach` metres: dust and wrong matches would
/// stretch the body below them.
/// @param clusters is working memory
inline void remove_isolated_points(const CandidatePoints& points, float reach,
                                   EuclideanClusters& clusters, CandidatePoints& kept) {
  clusters.cluster(points.points, reach);
  kept.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (clusters.sizes()[clusters.labels()[i]] < 2) continue;
    kept.push_back(points.points, i, points.slope_x[i], points.slope_y[i], points.height[i]);
  }
}

/// How far lone points are looked around at, in units of the clusters' tolerance.
inline constexpr float kIsolationReach = 1.5F;

}  // namespace scree
