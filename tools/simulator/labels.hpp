#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scree/detect/detector.hpp"
#include "scree/learn/sample.hpp"
#include "simulator/terrain.hpp"

namespace scree {

/// What the detector made of one terrain or of several.
struct LabelledClusters {
  std::vector<Sample> samples;
  std::size_t obstacles = 0;  ///< rocks and holes that are asked for
  std::size_t found = 0;      ///< of them those with a cluster

  LabelledClusters& operator+=(const LabelledClusters& other);
};

/// Names the truth of each cluster of the detector's last cloud, which must lie in the frame of
/// the features: the feature whose footprint, grown by 0.15 m, covers the middle of the cluster's
/// box or at least half of its points. Left out are clusters whose features are not finite, and
/// those of stones and dents too small to be asked for.
/// @param asked ids of the features that count as obstacles asked for; other features still give
/// their clusters a label
/// @param least_piece share of the points of an obstacle's largest cluster; smaller ones are left
/// out: splinters of it, or tufts that stand beside it
LabelledClusters label_clusters(const Detector& detector, std::span<const TerrainFeature> features,
                                std::span<const int> asked, double least_piece = 0);

}  // namespace scree
