#include "scoring/scoring.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "scoring/matching.hpp"

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
  for (const auto& [obstacle, range, is_right] : comparison.asked) {
    const auto add = [&, right = is_right](Score& score) {
      ++(right ? score.true_positives : score.false_negatives);
    };
    add(of_kind(result.scores, obstacle->kind));
    add(of_kind(result.by_range[band_of(range)], obstacle->kind));
    add(of_size(result, obstacle->kind, obstacle->height));
    if (!obstacle->shape.empty()) add(result.by_shape[obstacle->shape]);
  }
  for (const auto& [detection, range] : comparison.false_alarms) {
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

  void tell(const Comparison::Asked& now) {
    obstacle = now.obstacle;
    if (!asked) asked = now.range;
    if (!now.is_right) {
      stayed.reset();
      return;
    }
    if (!first) first = now.range;
    if (!stayed) stayed = now.range;
  }
};

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

void Scorer::add(const Truth& truth, std::span<const ObstacleList> lists) {
  std::set<std::size_t> covered;
  std::map<int, Story> stories;
  std::vector<PosePair> poses;
  for (const ObstacleList& list : lists) {
    const auto entry = entry_of(truth, lists, list.stamp_ns);
    if (!entry) {
      ++result_.lists_without_entry;
      continue;
    }
    covered.insert(*entry);
    const Comparison comparison = compare(truth, truth.visible[*entry], list);
    count(result_, comparison);
    for (const auto& asked : comparison.asked) stories[asked.obstacle->id].tell(asked);
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
