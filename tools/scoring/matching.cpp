#include "scoring/matching.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

namespace scree {
namespace {

constexpr double kGrowth = 0.3;        // metres
constexpr double kLeastOverlap = 0.2;  // intersection over union

/// What lies on the ground, seen in base.
struct Shadow {
  Eigen::Vector2d center;
  Outline outline;
  double reach = 0;  // of the farthest corner from the centre

  Shadow(const Pose& to_base, const Eigen::Vector3d& middle, const Outline& corners)
      : center((to_base * middle).head<2>()) {
    outline.reserve(corners.size());
    for (const Eigen::Vector2d& corner : corners) {
      outline.emplace_back(
          (to_base * Eigen::Vector3d(corner.x(), corner.y(), middle.z())).head<2>());
      reach = std::max(reach, (outline.back() - center).norm());
    }
  }
  double range() const { return center.norm(); }
};

bool can_match(const Shadow& detection, const Shadow& obstacle) {
  const double apart = (detection.center - obstacle.center).norm();
  if (apart > obstacle.reach + std::max(kGrowth, detection.reach)) return false;
  return distance_to(obstacle.outline, detection.center) <= kGrowth ||
         intersection_over_union(obstacle.outline, detection.outline) >= kLeastOverlap;
}

/// A detection and an obstacle that it can match, by their numbers.
struct Candidate {
  double apart;
  std::size_t obstacle, detection;
};

std::vector<Candidate> candidates(const std::vector<Shadow>& obstacles,
                                  const std::vector<Shadow>& detections) {
  std::vector<Candidate> all;
  for (std::size_t o = 0; o < obstacles.size(); ++o) {
    for (std::size_t d = 0; d < detections.size(); ++d) {
      if (!can_match(detections[d], obstacles[o])) continue;
      all.push_back({(detections[d].center - obstacles[o].center).norm(), o, d});
    }
  }
  std::ranges::sort(all, {}, [](const Candidate& each) {
    return std::tuple(each.apart, each.obstacle, each.detection);
  });
  return all;
}

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// One detection at most for each obstacle and the other way round; kNone without a partner.
struct Matching {
  std::vector<std::size_t> found_by;  ///< detection of each obstacle
  std::vector<std::size_t> finds;     ///< obstacle of each detection
};

/// @param may_match whether the obstacle with this index takes part
Matching match(std::size_t obstacles, std::size_t detections,
               const std::vector<Candidate>& nearest_first,
               const std::function<bool(std::size_t)>& may_match) {
  Matching matching{std::vector(obstacles, kNone), std::vector(detections, kNone)};
  for (const auto& [apart, obstacle, detection] : nearest_first) {
    if (matching.found_by[obstacle] != kNone || matching.finds[detection] != kNone) continue;
    if (!may_match(obstacle)) continue;
    matching.found_by[obstacle] = detection;
    matching.finds[detection] = obstacle;
  }
  return matching;
}

/// Whether a moving obstacle covered a place in base in the seconds before.
bool lies_behind_one(const Eigen::Vector2d& place, const Truth& truth, const Pose& true_to_base,
                     std::int64_t stamp_ns) {
  constexpr std::int64_t kSeconds = 10, kStepNs = 100'000'000;
  for (const TrueObstacle& obstacle : truth.obstacles) {
    if (!obstacle.moves()) continue;
    for (std::int64_t step = 0; step <= kSeconds * 1'000'000'000 / kStepNs; ++step) {
      const TrueObstacle then = obstacle.at(stamp_ns - step * kStepNs);
      const Shadow shadow(true_to_base, then.center, then.footprint);
      if (distance_to(shadow.outline, place) <= kGrowth) return true;
    }
  }
  return false;
}

}  // namespace

Comparison compare(const Truth& truth, const Truth::Sight& sight, const ObstacleList& list) {
  const Pose true_to_base = truth.pose_at(list.stamp_ns).inverse();
  const Pose reported_to_base = list.pose.inverse();
  std::vector<Shadow> obstacles, detections;
  for (const TrueObstacle& each : truth.obstacles) {
    const TrueObstacle there = each.at(list.stamp_ns);
    obstacles.emplace_back(true_to_base, there.center, there.footprint);
  }
  for (const Obstacle& each : list.obstacles) {
    const ConvexPolygon outline = outline_of(each);
    detections.emplace_back(reported_to_base, each.center, Outline(outline.begin(), outline.end()));
  }
  const std::vector<Candidate> nearest_first = candidates(obstacles, detections);
  const auto is_in = [&](const std::vector<int>& ids, std::size_t obstacle) {
    return std::ranges::find(ids, truth.obstacles[obstacle].id) != ids.end();
  };
  const auto [found_by, finds] =
      match(obstacles.size(), detections.size(), nearest_first,
            [&](std::size_t obstacle) { return is_in(sight.ids, obstacle); });

  Comparison comparison;
  for (const int id : sight.ids) {
    const auto at = std::ranges::find(truth.obstacles, id, &TrueObstacle::id);
    const auto o = static_cast<std::size_t>(at - truth.obstacles.begin());
    const bool is_right = found_by[o] != kNone && list.obstacles[found_by[o]].kind == at->kind;
    const Obstacle* const detection = is_right ? &list.obstacles[found_by[o]] : nullptr;
    comparison.asked.push_back({&*at, obstacles[o].range(), detection});
  }
  for (std::size_t d = 0; d < detections.size(); ++d) {
    const Obstacle& detection = list.obstacles[d];
    if (finds[d] != kNone) {
      if (truth.obstacles[finds[d]].kind == detection.kind) continue;
    } else {
      const auto nearest = std::ranges::find(nearest_first, d, &Candidate::detection);
      if (nearest != nearest_first.end() && is_in(sight.ignore, nearest->obstacle)) continue;
    }
    const bool is_ghost = !detection.velocity.isZero() ||
                          lies_behind_one(detections[d].center, truth, true_to_base, list.stamp_ns);
    comparison.false_alarms.push_back({&detection, detections[d].range(), is_ghost});
  }
  return comparison;
}

}  // namespace scree
