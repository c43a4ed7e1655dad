#include "scoring/scoring.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace scree {
namespace {

constexpr std::uint64_t kNearNs = 60'000'000;
constexpr double kLeastWay = 0.1;  // metres; below it a robot stood still

/// Exact, and without overflow for any two times.
std::uint64_t apart(std::int64_t a, std::int64_t b) {
  return a > b ? static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b)
               : static_cast<std::uint64_t>(b) - static_cast<std::uint64_t>(a);
}

/// The visible entry nearest in time, the earlier of two; none when it is too far.
std::optional<std::size_t> entry_of(const Truth& truth, std::span<const ObstacleList> lists,
                                    std::int64_t stamp_ns) {
  if (truth.visible.size() == 1 && lists.size() == 1) return 0;
  const auto nearest = std::ranges::min_element(
      truth.visible, {}, [&](const Truth::Sight& sight) { return apart(sight.t_ns, stamp_ns); });
  if (nearest == truth.visible.end() || apart(nearest->t_ns, stamp_ns) > kNearNs) return {};
  return static_cast<std::size_t>(nearest - truth.visible.begin());
}

Score& of_kind(Scores& scores, ObstacleKind kind) {
  return kind == ObstacleKind::positive ? scores.positive : scores.negative;
}

Score& of_size(ScoringResult& result, ObstacleKind kind, double height) {
  const auto& bands = ScoringResult::kSizeBands;
  const auto above = std::upper_bound(bands.begin() + 1, bands.end(), std::abs(height));
  auto& sizes = kind == ObstacleKind::positive ? result.positive_sizes : result.negative_sizes;
  return sizes[static_cast<std::size_t>(above - bands.begin()) - 1];
}

int band_of(double range) {
  return static_cast<int>(range / ScoringResult::kRangeBand);
}

void count(ScoringResult& result, const Comparison& comparison) {
  for (const Comparison::Asked& asked : comparison.asked) {
    const auto& [obstacle, range, detection] = asked;
    const auto add = [&](Score& score) {
      ++(asked.is_right() ? score.true_positives : score.false_negatives);
    };
    add(of_kind(result.scores, obstacle->kind));
    add(of_kind(result.by_range[band_of(range)], obstacle->kind));
    add(of_size(result, obstacle->kind, obstacle->height));
    if (!obstacle->shape.empty()) add(result.by_shape[obstacle->shape]);
  }
  for (const auto& [detection, range, is_ghost] : comparison.false_alarms) {
    ++of_kind(result.scores, detection->kind).false_positives;
    ++of_kind(result.by_range[band_of(range)], detection->kind).false_positives;
    ++of_size(result, detection->kind, detection->height).false_positives;
  }
}

/// How one obstacle fared, list by list.
struct Story {
  const TrueObstacle* obstacle = nullptr;
  std::optional<double> asked;   // range when it was asked for first
  std::optional<double> first;   // range at the first right match
  std::optional<double> stayed;  // range at which the right matches began that have not ended
  std::int64_t asked_ns = 0, first_ns = 0;  // when

  void tell(const Comparison::Asked& now, std::int64_t now_ns) {
    obstacle = now.obstacle;
    if (!asked) asked_ns = now_ns;
    if (!asked) asked = now.range;
    if (!now.is_right()) {
      stayed.reset();
      return;
    }
    if (!first) first_ns = now_ns;
    if (!first) first = now.range;
    if (!stayed) stayed = now.range;
  }
  double delay() const { return static_cast<double>(first_ns - asked_ns) * 1e-9; }
};

/// Counts apart what moves and what stands.
void count_moving(ScoringResult& result, const Comparison& comparison, const Truth& truth,
                  const ObstacleList& list, const std::map<int, Story>& stories) {
  constexpr std::int64_t kSettled = 500'000'000;  // after the first match
  MovingScore& moving = result.moving;
  const Eigen::Quaterniond to_truth =
      truth.pose_at(list.stamp_ns).rotation * list.pose.rotation.conjugate();
  for (const Comparison::Asked& asked : comparison.asked) {
    if (!asked.obstacle->moves()) {
      Score& standing = of_kind(result.standing, asked.obstacle->kind);
      ++(asked.is_right() ? standing.true_positives : standing.false_negatives);
      continue;
    }
    ++moving.asked;
    if (!asked.is_right()) continue;
    ++moving.found;
    if (list.stamp_ns < stories.at(asked.obstacle->id).first_ns + kSettled) continue;
    const Eigen::Vector2d& velocity = asked.detection->velocity;
    const Eigen::Vector3d in_truth = to_truth * Eigen::Vector3d(velocity.x(), velocity.y(), 0);
    moving.velocity_errors.push_back(
        (in_truth.head<2>() - asked.obstacle->velocity_at(list.stamp_ns)).norm());
  }
  ++moving.lists;
  const auto ghosts = static_cast<std::size_t>(
      std::ranges::count(comparison.false_alarms, true, &Comparison::FalseAlarm::is_ghost));
  moving.ghosts += ghosts;
  moving.lists_with_ghosts += ghosts > 0 ? 1 : 0;
  for (const Comparison::FalseAlarm& alarm : comparison.false_alarms) {
    ++of_kind(result.standing, alarm.detection->kind).false_positives;
  }
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

double ScoringResult::coverage() const {
  return entries == 0 ? 1 : static_cast<double>(covered) / static_cast<double>(entries);
}

void Scorer::add(const Truth& truth, std::span<const ObstacleList> lists,
                 const OnComparison& on_comparison) {
  std::set<std::size_t> covered;
  std::map<int, Story> stories;
  std::vector<PosePair> poses;
  const bool has_moving = std::ranges::any_of(truth.obstacles, &TrueObstacle::moves);
  for (const ObstacleList& list : lists) {
    const auto entry = entry_of(truth, lists, list.stamp_ns);
    if (!entry) {
      ++result_.lists_without_entry;
      continue;
    }
    covered.insert(*entry);
    const Comparison comparison = compare(truth, truth.visible[*entry], list);
    count(result_, comparison);
    if (on_comparison) on_comparison(list, comparison);
    for (const auto& asked : comparison.asked) {
      stories[asked.obstacle->id].tell(asked, list.stamp_ns);
    }
    if (has_moving) count_moving(result_, comparison, truth, list, stories);
    poses.push_back({list.stamp_ns, list.pose, truth.pose_at(list.stamp_ns)});
  }
  ++result_.runs;
  result_.lists += lists.size();
  result_.entries += truth.visible.size();
  result_.covered += covered.size();
  const auto entries = static_cast<double>(truth.visible.size());
  if (static_cast<double>(covered.size()) < ScoringResult::kLeastCoverage * entries) {
    ++result_.runs_not_covered;
  }
  if (truth.visible.size() > 1) {
    for (const auto& [id, story] : stories) {
      if (story.obstacle->moves()) {
        ++result_.moving.obstacles;
        if (story.first) result_.moving.delays.push_back(story.delay());
        continue;
      }
      WarningDistances& warning = story.obstacle->kind == ObstacleKind::positive
                                      ? result_.positive_warning
                                      : result_.negative_warning;
      ++warning.obstacles;
      warning.asked.push_back(*story.asked);
      if (story.first) warning.first.push_back(*story.first);
      if (story.stayed) warning.stayed.push_back(*story.stayed);
    }
  }
  if (const PoseError error = pose_error(poses); error.way >= kLeastWay) {
    result_.pose_errors.push_back(error);
  }
}

}  // namespace scree
