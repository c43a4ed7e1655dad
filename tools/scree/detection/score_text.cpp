#include "detection/score_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "scree/core/pose.hpp"

namespace scree::cli {
namespace {

using Json = nlohmann::ordered_json;

/// A share that a score has, or none where it is one of nothing.
std::optional<double> precision_of(const Score& score) {
  return score.true_positives + score.false_positives == 0 ? std::nullopt
                                                           : std::optional(score.precision());
}
std::optional<double> recall_of(const Score& score) {
  return score.true_positives + score.false_negatives == 0 ? std::nullopt
                                                           : std::optional(score.recall());
}
std::optional<double> f1_of(const Score& score) {
  return score.true_positives + score.false_positives + score.false_negatives == 0
             ? std::nullopt
             : std::optional(score.f1());
}

std::optional<double> share_found(const MovingScore& moving) {
  if (moving.asked == 0) return std::nullopt;
  return static_cast<double>(moving.found) / static_cast<double>(moving.asked);
}

double greatest(const std::vector<double>& values) {
  return values.empty() ? 0 : std::ranges::max(values);
}

std::string shown(std::optional<double> share) {
  return share ? fmt::format("{:.3f}", *share) : "-";
}

Json to_json(std::optional<double> share) {
  return share ? Json(*share) : Json(nullptr);
}

std::string head(std::string_view what) {
  const bool has_line_feed = what.starts_with('\n');
  return fmt::format("{:<{}}{:>7}{:>7}{:>7}{:>11}{:>8}{:>8}\n", what, has_line_feed ? 23 : 22, "TP",
                     "FP", "FN", "precision", "recall", "F1");
}

std::string row(const std::string& what, const Score& score) {
  return fmt::format("{:<22}{:>7}{:>7}{:>7}{:>11}{:>8}{:>8}\n", what, score.true_positives,
                     score.false_positives, score.false_negatives, shown(precision_of(score)),
                     shown(recall_of(score)), shown(f1_of(score)));
}

std::string band_name(double from, double to) {
  return to < std::numeric_limits<double>::infinity() ? fmt::format("{:g} - {:g} m", from, to)
                                                      : fmt::format("{:g} m and more", from);
}

double end_of_size(std::size_t band) {
  return band + 1 < ScoringResult::kSizeBands.size() ? ScoringResult::kSizeBands[band + 1]
                                                     : std::numeric_limits<double>::infinity();
}

std::string size_rows(std::string_view what, const ScoringResult::SizeScores& sizes) {
  std::string rows;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (!f1_of(sizes[i])) continue;
    const double from = ScoringResult::kSizeBands[i];
    rows += row(fmt::format("{} {}", what, band_name(from, end_of_size(i))), sizes[i]);
  }
  return rows;
}

std::string warning_row(std::string_view kind, const WarningDistances& warning) {
  const auto shown_of = [](const std::vector<double>& all) {
    if (all.empty()) return std::string("     -       -");
    return fmt::format("{:6.2f}  {:6.2f}", median(all), std::ranges::min(all));
  };
  return fmt::format("{:<10}{:>9}{:>10}  {}   {:>8}  {}\n", kind, warning.obstacles,
                     warning.first.size(), shown_of(warning.first), warning.stayed.size(),
                     shown_of(warning.stayed));
}

std::string warning_table(const ScoringResult& result) {
  if (result.positive_warning.obstacles + result.negative_warning.obstacles == 0) return "";
  return "\nwarning distance [m]         first right match           from then on always right\n"
         "kind      obstacles  reported  median   least   reported  median   least\n" +
         warning_row("positive", result.positive_warning) +
         warning_row("negative", result.negative_warning);
}

std::string moving_table(const ScoringResult& result) {
  const MovingScore& moving = result.moving;
  if (moving.lists == 0) return "";
  return head("\nstanding") + row("all", result.standing.all()) +
         row("positive", result.standing.positive) + row("negative", result.standing.negative) +
         fmt::format("\nmoving: found in {} of {} lists that ask for one ({})\n", moving.found,
                     moving.asked, shown(share_found(moving))) +
         fmt::format("{} of {} reported, after {:.2f} s (median) and {:.2f} s (most)\n",
                     moving.delays.size(), moving.obstacles, median(moving.delays),
                     greatest(moving.delays)) +
         fmt::format("velocity off by {:.2f} m/s (median), {:.2f} m/s (most)\n",
                     median(moving.velocity_errors), greatest(moving.velocity_errors)) +
         fmt::format("{} ghosts, in {} of {} lists\n", moving.ghosts, moving.lists_with_ghosts,
                     moving.lists);
}

std::string pose_table(const ScoringResult& result) {
  if (result.pose_errors.empty()) return "";
  std::string text = fmt::format(
      "\n{:<12}{:>9}{:>9}{:>8}{:>9}{:>8}{:>9}{:>8}{:>9}{:>8}\n"
      "{:<12}{:>9}{:>9}{:>8}{:>9}{:>8}{:>9}{:>8}{:>9}{:>8}\n",
      "pose error", "way", "final", "most", "final", "most", "yaw", "most", "yaw", "most", "", "m",
      "m", "m", "% of way", "%", "deg", "deg", "deg/min", "deg/min");
  for (std::size_t i = 0; i < result.pose_errors.size(); ++i) {
    const PoseError& error = result.pose_errors[i];
    text += fmt::format("drive {:<6}{:>9.2f}{:>9.3f}{:>8.3f}{:>9.2f}{:>8.2f}", i + 1, error.way,
                        error.last, error.most, 100 * error.share(), 100 * error.most_share());
    text += fmt::format("{:>9.2f}{:>8.2f}{:>9.2f}{:>8.2f}\n", degrees(error.yaw),
                        degrees(error.most_yaw), degrees(error.yaw_per_minute()),
                        degrees(error.most_yaw_per_minute()));
  }
  return text;
}

Json to_json(const Score& score) {
  return {{"true_positives", score.true_positives},   {"false_positives", score.false_positives},
          {"false_negatives", score.false_negatives}, {"precision", to_json(precision_of(score))},
          {"recall", to_json(recall_of(score))},      {"f1", to_json(f1_of(score))}};
}

Json to_json(const Scores& scores) {
  return {{"all", to_json(scores.all())},
          {"positive", to_json(scores.positive)},
          {"negative", to_json(scores.negative)}};
}

Json to_json(const ScoringResult::SizeScores& sizes) {
  Json bands = Json::array();
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    Json band{{"from", ScoringResult::kSizeBands[i]}, {"to", nullptr}};
    if (i + 1 < sizes.size()) band["to"] = end_of_size(i);
    band.update(to_json(sizes[i]));
    bands.push_back(band);
  }
  return bands;
}

Json to_json(const WarningDistances& warning) {
  const auto summary = [](const std::vector<double>& all) -> Json {
    Json json{{"reported", all.size()}, {"median", nullptr}, {"least", nullptr}};
    if (all.empty()) return json;
    json["median"] = median(all);
    json["least"] = std::ranges::min(all);
    return json;
  };
  return {{"obstacles", warning.obstacles},
          {"first", summary(warning.first)},
          {"stayed", summary(warning.stayed)}};
}

Json to_json(const MovingScore& moving) {
  const auto summary = [](const std::vector<double>& all) -> Json {
    if (all.empty()) return {{"median", nullptr}, {"most", nullptr}};
    return {{"median", median(all)}, {"most", std::ranges::max(all)}};
  };
  return {{"asked", moving.asked},
          {"found", moving.found},
          {"recall", to_json(share_found(moving))},
          {"obstacles", moving.obstacles},
          {"reported", moving.delays.size()},
          {"delay_s", summary(moving.delays)},
          {"velocity_error", summary(moving.velocity_errors)},
          {"lists", moving.lists},
          {"ghosts", moving.ghosts},
          {"lists_with_ghosts", moving.lists_with_ghosts}};
}

Json to_json(const PoseError& error) {
  return {{"way", error.way},
          {"seconds", error.seconds},
          {"final", error.last},
          {"most", error.most},
          {"final_share_of_way", error.share()},
          {"most_share_of_way", error.most_share()},
          {"yaw_deg", degrees(error.yaw)},
          {"most_yaw_deg", degrees(error.most_yaw)},
          {"yaw_deg_per_minute", degrees(error.yaw_per_minute())},
          {"most_yaw_deg_per_minute", degrees(error.most_yaw_per_minute())}};
}

}  // namespace

std::string score_table(const ScoringResult& result) {
  std::string text = head("");
  text += row("all", result.scores.all()) + row("positive", result.scores.positive) +
          row("negative", result.scores.negative);
  text += fmt::format("\ncoverage {:.3f}: {} of {} visible entries have a list", result.coverage(),
                      result.covered, result.entries);
  text += result.runs > 1 ? fmt::format(" ({} runs)\n", result.runs) : "\n";
  if (!result.counts()) {
    text += fmt::format("this score does not count: coverage under {:g}",
                        ScoringResult::kLeastCoverage);
    text += result.runs > 1
                ? fmt::format(" in {} of {} runs\n", result.runs_not_covered, result.runs)
                : "\n";
  }
  if (result.lists_without_entry > 0) {
    text += fmt::format("{} of {} lists have no visible entry within 60 ms and were not scored\n",
                        result.lists_without_entry, result.lists);
  }
  if (!result.by_range.empty()) text += head("\ndistance");
  for (const auto& [band, scores] : result.by_range) {
    const double from = band * ScoringResult::kRangeBand;
    text += row(band_name(from, from + ScoringResult::kRangeBand), scores.all());
  }
  const std::string sizes =
      size_rows("high", result.positive_sizes) + size_rows("deep", result.negative_sizes);
  if (!sizes.empty()) text += head("\nsize") + sizes;
  if (!result.by_shape.empty()) {
    text += fmt::format("\n{:<22}{:>7}{:>7}{:>7}{:>19}\n", "shape", "TP", "", "FN", "recall");
  }
  for (const auto& [shape, score] : result.by_shape) {
    text += fmt::format("{:<22}{:>7}{:>7}{:>7}{:>19}\n", shape, score.true_positives, "",
                        score.false_negatives, shown(recall_of(score)));
  }
  return text + moving_table(result) + warning_table(result) + pose_table(result);
}

std::string score_json(const ScoringResult& result) {
  Json json{{"runs", result.runs},
            {"lists", result.lists},
            {"lists_without_entry", result.lists_without_entry},
            {"entries", result.entries},
            {"covered", result.covered},
            {"coverage", result.coverage()},
            {"runs_not_covered", result.runs_not_covered},
            {"counts", result.counts()}};
  json.update(to_json(result.scores));
  if (result.moving.lists > 0) {
    json["standing"] = to_json(result.standing);
    json["moving"] = to_json(result.moving);
  }
  json["range"] = Json::array();
  for (const auto& [band, scores] : result.by_range) {
    const double from = band * ScoringResult::kRangeBand;
    Json entry{{"from", from}, {"to", from + ScoringResult::kRangeBand}};
    entry.update(to_json(scores));
    json["range"].push_back(entry);
  }
  json["size"] = {{"positive", to_json(result.positive_sizes)},
                  {"negative", to_json(result.negative_sizes)}};
  json["shape"] = Json::object();
  for (const auto& [shape, score] : result.by_shape) {
    json["shape"][shape] = {{"true_positives", score.true_positives},
                            {"false_negatives", score.false_negatives},
                            {"recall", to_json(recall_of(score))}};
  }
  json["warning_distance"] = {{"positive", to_json(result.positive_warning)},
                              {"negative", to_json(result.negative_warning)}};
  json["pose_error"] = Json::array();
  for (const PoseError& error : result.pose_errors) json["pose_error"].push_back(to_json(error));
  return json.dump(2) + "\n";
}

}  // namespace scree::cli
