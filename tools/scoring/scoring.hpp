#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scoring/matching.hpp"
#include "scoring/pose_error.hpp"
#include "scoring/truth.hpp"
#include "scree/learn/metrics.hpp"

namespace scree {

/// How far ahead the obstacles of one kind were reported. Distances in metres from base in its x-y
/// plane, one for each obstacle that was.
struct WarningDistances {
  std::size_t obstacles = 0;   ///< asked for at least once
  std::vector<double> asked;   ///< when it was asked for first: no match counts before that
  std::vector<double> first;   ///< at the first right match
  std::vector<double> stayed;  ///< at the first right match from which on every list that was asked
                               ///< for the obstacle had it right
};

double median(std::vector<double> values);  ///< 0 for none

/// How obstacles that move fared.
struct MovingScore {
  std::size_t asked = 0, found = 0;     ///< in all lists
  std::size_t obstacles = 0;            ///< asked for at least once
  std::vector<double> delays;           ///< from the first list that was asked for one to its first
                                        ///< right match, seconds; none of those never found
  std::vector<double> velocity_errors;  ///< of right matches 0.5 s after the first one, m/s
  std::size_t lists = 0;                ///< of the runs that have some
  std::size_t ghosts = 0;               ///< false positives that move, or lie where one has been
  std::size_t lists_with_ghosts = 0;
};

/// What the scoring says of any number of runs.
struct ScoringResult {
  static constexpr double kLeastCoverage = 0.95;
  static constexpr double kRangeBand = 2;  ///< metres
  /// Lower ends of the bands of height or depth, metres.
  static constexpr std::array kSizeBands = {0.0, 0.15, 0.3, 0.6};
  using SizeScores = std::array<Score, kSizeBands.size()>;

  std::size_t runs = 0;
  std::size_t lists = 0;
  std::size_t lists_without_entry = 0;  ///< no visible entry within 60 ms: not scored
  std::size_t entries = 0;              ///< of visible
  std::size_t covered = 0;              ///< of them those with a list
  std::size_t runs_not_covered = 0;     ///< coverage under kLeastCoverage

  Scores scores;
  /// Of what stands, in runs where something moves; every false positive counts.
  Scores standing;
  MovingScore moving;
  /// By distance, the key times kRangeBand is a band's near end; a false positive stands at the
  /// range of the detection, the others at that of the obstacle.
  std::map<int, Scores> by_range;
  /// By height or depth; a false positive by that of the detection.
  SizeScores positive_sizes{}, negative_sizes{};
  /// Right matches and misses by what the truth calls the obstacle; no false positives.
  std::map<std::string, Score> by_shape;
  WarningDistances positive_warning, negative_warning;  ///< of runs with several entries
  std::vector<PoseError> pose_errors;                   ///< of runs in which the robot moved

  double coverage() const;
  /// A score with less coverage does not count.
  bool counts() const { return runs_not_covered == 0; }
};

/// Scores lists of detections against truth, run by run.
class Scorer {
public:
  using OnComparison = std::function<void(const ObstacleList&, const Comparison&)>;

  /// @param lists of one run, in time order. @pre truth as read_truth() lets it pass
  /// @param on_comparison called for each list that is scored
  void add(const Truth& truth, std::span<const ObstacleList> lists,
           const OnComparison& on_comparison = {});
  const ScoringResult& result() const { return result_; }

private:
  ScoringResult result_;
};

}  // namespace scree
