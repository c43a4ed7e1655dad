#include "training/labels.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "scoring/matching.hpp"
#include "scree/detect/obstacle_box.hpp"

namespace scree {
namespace {

constexpr double kGrowth = 0.15;

/// The ground that an obstacle covers. Mounds and hollows cover none: an obstacle may lie on one.
class CoveredGround {
public:
  explicit CoveredGround(const TerrainFeature& feature) : feature_(&feature) {
    for (const Eigen::Vector2d& corner : feature.footprint) bounds_.extend(corner);
  }
  bool covers(const Eigen::Vector2d& point) const {
    return bounds_.exteriorDistance(point) <= kGrowth &&
           distance(feature_->footprint, point) <= kGrowth;
  }
  const TerrainFeature* feature() const { return feature_; }

private:
  const TerrainFeature* feature_;
  Eigen::AlignedBox2d bounds_;
};

/// The feature that a cluster belongs to, null for none.
const TerrainFeature* feature_of(const Cluster& cluster, const ClusteredPoints& found,
                                 std::span<const CoveredGround> grounds) {
  const Eigen::Vector2d middle(static_cast<double>(cluster.box.center_x),
                               static_cast<double>(cluster.box.center_y));
  for (const CoveredGround& ground : grounds) {
    if (ground.covers(middle)) return ground.feature();
  }
  const auto members = found.clusters.members(cluster);
  const PointCloud& points = found.points.points;
  for (const CoveredGround& ground : grounds) {
    const auto covered = std::ranges::count_if(members, [&](std::uint32_t i) {
      return ground.covers({static_cast<double>(points.x[i]), static_cast<double>(points.y[i])});
    });
    if (2 * static_cast<std::size_t>(covered) >= members.size()) return ground.feature();
  }
  return nullptr;
}

Label label_of(ObstacleKind kind) {
  return kind == ObstacleKind::positive ? Label::positive : Label::negative;
}

/// The rim of a hole is no hole, and a hollow beside a rock no rock.
Label label_of(const TerrainFeature* feature, const Features& features) {
  if (feature == nullptr) return Label::none;
  if (feature->kind == ObstacleKind::positive) {
    return features[max_height] > 0 ? Label::positive : Label::none;
  }
  return features[min_height] < 0 ? Label::negative : Label::none;
}

/// One more than the largest id.
std::size_t id_limit(std::span<const TerrainFeature> features) {
  int largest = 0;
  for (const TerrainFeature& feature : features) largest = std::max(largest, feature.id);
  return static_cast<std::size_t>(largest) + 1;
}

}  // namespace

LabelledClusters& LabelledClusters::operator+=(const LabelledClusters& other) {
  samples.insert(samples.end(), other.samples.begin(), other.samples.end());
  obstacles += other.obstacles;
  found += other.found;
  return *this;
}

LabelledClusters label_clusters(const ClusteredPoints& found,
                                std::span<const TerrainFeature> features,
                                std::span<const int> asked, double least_piece) {
  struct Named {
    Sample sample;
    int id;  // of the feature, 0 for none
    std::uint32_t points;
  };
  std::vector<CoveredGround> grounds;
  for (const TerrainFeature& feature : features) {
    if (feature.kind) grounds.emplace_back(feature);
  }
  std::vector<Named> all;
  std::vector<std::uint32_t> largest(id_limit(features));
  for (const Cluster& cluster : found.clusters.all()) {
    if (!std::ranges::all_of(cluster.features, [](float f) { return std::isfinite(f); })) continue;
    const TerrainFeature* feature = feature_of(cluster, found, grounds);
    if (feature != nullptr && feature->is_small) continue;
    const Label label = label_of(feature, cluster.features);
    const int id = feature != nullptr ? feature->id : 0;
    const std::uint32_t points = cluster.end - cluster.begin;
    all.push_back({{cluster.features, label}, id, points});
    std::uint32_t& most = largest[static_cast<std::size_t>(id)];
    most = std::max(most, points);
  }
  LabelledClusters labelled;
  labelled.obstacles = asked.size();
  for (const Named& named : all) {
    const double least = least_piece * largest[static_cast<std::size_t>(named.id)];
    if (named.sample.label != Label::none && named.points < least) continue;
    labelled.samples.push_back(named.sample);
  }
  for (const int id : asked) labelled.found += largest[static_cast<std::size_t>(id)] > 0 ? 1U : 0U;
  return labelled;
}

LabelledClusters label_tracks(std::span<const Tracker::Track> tracks,
                              const TrackingSettings& tracking, const Pose& base,
                              std::int64_t stamp_ns, const Truth& truth,
                              const std::set<int>& known) {
  Truth::Sight sight{stamp_ns, {known.begin(), known.end()}, {}};
  for (const TrueObstacle& each : truth.obstacles) {
    if (!known.contains(each.id)) sight.ignore.push_back(each.id);
  }
  std::vector<const Tracker::Track*> surest_first;
  for (const Tracker::Track& track : tracks) {
    const bool is_near = distance_to_box(track.obstacle, base.translation) <= tracking.reach;
    if (is_near && track.found >= static_cast<float>(tracking.least_found))
      surest_first.push_back(&track);
  }
  std::ranges::stable_sort(surest_first, std::ranges::greater(), &Tracker::Track::smoothed);
  LabelledClusters labelled;
  labelled.obstacles = known.size();
  std::set<int> found;
  ObstacleList list(1);
  list.stamp_ns = stamp_ns;
  list.pose = base;
  for (const Tracker::Track* track : surest_first) {
    list.obstacles.clear();
    list.obstacles.push_back(track->obstacle);
    list.obstacles[0].kind =
        track->obstacle.height > 0 ? ObstacleKind::positive : ObstacleKind::negative;
    const Comparison comparison = compare(truth, sight, list);
    const auto right = std::ranges::find(comparison.asked, true, &Comparison::Asked::is_right);
    Label label = Label::none;
    if (right != comparison.asked.end()) {
      const bool is_first = found.insert(right->obstacle->id).second;
      if (is_first) label = label_of(right->obstacle->kind);
    } else if (comparison.false_alarms.empty()) {
      continue;
    }
    labelled.samples.push_back({track->features, label});
  }
  labelled.found = found.size();
  return labelled;
}

}  // namespace scree
