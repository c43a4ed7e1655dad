#include "simulator/labels.hpp"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

constexpr double kGrowth = 0.15;

/// Mounds and hollows cover nothing: an obstacle may lie on one.
bool covers(const TerrainFeature& feature, const Eigen::Vector2d& point) {
  return feature.kind && distance(feature.footprint, point) <= kGrowth;
}

/// The feature that a cluster belongs to, null for none.
const TerrainFeature* feature_of(const Cluster& cluster, const Detector& detector,
                                 std::span<const TerrainFeature> features) {
  const Eigen::Vector2d middle(static_cast<double>(cluster.box.center_x),
                               static_cast<double>(cluster.box.center_y));
  for (const TerrainFeature& feature : features) {
    if (covers(feature, middle)) return &feature;
  }
  const auto members = detector.clusters().members(cluster);
  const PointCloud& points = detector.kept().points;
  for (const TerrainFeature& feature : features) {
    const auto covered = std::ranges::count_if(members, [&](std::uint32_t i) {
      return covers(feature, {static_cast<double>(points.x[i]), static_cast<double>(points.y[i])});
    });
    if (2 * static_cast<std::size_t>(covered) >= members.size()) return &feature;
  }
  return nullptr;
}

/// The rim of a hole is no hole, and a hollow beside a rock no rock.
Label label_of(const TerrainFeature* feature, const Features& features) {
  if (feature == nullptr) return Label::none;
  if (feature->kind == ObstacleKind::positive) {
    return features[max_height] > 0 ? Label::positive : Label::none;
  }
  return features[min_height] < 0 ? Label::negative : Label::none;
}

}  // namespace

LabelledClusters& LabelledClusters::operator+=(const LabelledClusters& other) {
  samples.insert(samples.end(), other.samples.begin(), other.samples.end());
  obstacles += other.obstacles;
  found += other.found;
  return *this;
}

LabelledClusters label_clusters(const Detector& detector, std::span<const TerrainFeature> features,
                                std::span<const int> asked) {
  LabelledClusters labelled;
  labelled.obstacles = asked.size();
  std::vector<bool> has_cluster(Terrain::kMostFeatures + 1);
  for (const Cluster& cluster : detector.clusters().all()) {
    if (!std::ranges::all_of(cluster.features, [](float f) { return std::isfinite(f); })) continue;
    const TerrainFeature* feature = feature_of(cluster, detector, features);
    if (feature != nullptr && feature->is_small) continue;
    labelled.samples.push_back({cluster.features, label_of(feature, cluster.features)});
    if (feature != nullptr) has_cluster[static_cast<std::size_t>(feature->id)] = true;
  }
  for (const int id : asked) labelled.found += has_cluster[static_cast<std::size_t>(id)] ? 1U : 0U;
  return labelled;
}

}  // namespace scree
