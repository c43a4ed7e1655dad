#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "scoring/truth.hpp"
#include "scree/core/pose.hpp"
#include "scree/detect/clusters.hpp"
#include "scree/detect/tracker.hpp"
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

/// Names the truth of each cluster of a cloud, which must lie in the frame of the features: the
/// feature whose footprint, grown by 0.15 m, covers the middle of the cluster's box or at least
/// half of its points. Left out are clusters whose features are not finite, and those of stones and
/// dents too small to be asked for.
/// @param asked ids of the features that count as obstacles asked for; other features still give
/// their clusters a label
/// @param least_piece share of the points of an obstacle's largest cluster; smaller ones are left
/// out: splinters of it, or tufts that stand beside it
LabelledClusters label_clusters(const ClusteredPoints& found,
                                std::span<const TerrainFeature> features,
                                std::span<const int> asked, double least_piece = 0);

/// Names the truth of each track within tracking.reach that may be published, as compare() matches
/// a list of this one alone. Of several tracks of an obstacle the surest is it, the others are
/// none. Left out are those of what is neither known nor nothing.
/// @param base where the robot is, in the tracks' frame
/// @param truth obstacles, and poses at stamp_ns
/// @param known ids of the obstacles that were asked for by now, wherever they lie
LabelledClusters label_tracks(std::span<const Tracker::Track> tracks,
                              const TrackingSettings& tracking, const Pose& base,
                              std::int64_t stamp_ns, const Truth& truth,
                              const std::set<int>& known);

}  // namespace scree
