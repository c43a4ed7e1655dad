#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "draw/chart.hpp"
#include "scree/core/pose.hpp"
#include "study/drive_results.hpp"

namespace scree::cli {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A number that each scene has, NaN where it has none.
struct Column {
  std::string name;  ///< with its unit
  int decimals;
  std::function<double(const SceneResult&)> value;
};
struct Block {
  std::string title;
  std::vector<Column> columns;
};

double f1_of(const ScoringResult& result) {
  const Score score = result.scores.all();
  const bool is_of_nothing =
      score.true_positives + score.false_positives + score.false_negatives == 0;
  return is_of_nothing ? kNone : score.f1();
}

double f1_of(const SceneResult& scene, DriveWay way) {
  return f1_of(scene.of(way));
}

double cost_after_faults(const SceneResult& scene) {
  return f1_of(scene.unharmed.result()) - f1_of(scene.healed.result());
}

double cost_of_faults(const SceneResult& scene) {
  return f1_of(scene, DriveWay::pipeline) - f1_of(scene, DriveWay::faults);
}

double median_of(const std::vector<double>& values) {
  return values.empty() ? kNone : median(values);
}
double least_of(const std::vector<double>& values) {
  return values.empty() ? kNone : std::ranges::min(values);
}
double largest_of(const std::vector<double>& values) {
  return values.empty() ? kNone : std::ranges::max(values);
}

/// At the end of a drive, percent of its way.
double drift(const PoseError& error) {
  return 100 * error.share();
}

/// At the end of a drive, degrees; of a drive longer than a minute degrees a minute. Most of the
/// yaw comes in the first metres: drives of seconds do not say what comes in a minute.
double yaw(const PoseError& error) {
  return degrees(std::abs(error.yaw)) / std::max(error.seconds / 60, 1.0);
}

/// Degrees a minute, as if it went on as in the drive.
double yaw_a_minute(const PoseError& error) {
  return degrees(std::abs(error.yaw_per_minute()));
}

double way_driven(const SceneResult& scene) {
  double sum = 0;
  for (const PoseError& error : scene.of(DriveWay::pipeline).pose_errors) sum += error.way;
  return sum;
}

Block detection_block() {
  const auto f1 = [](DriveWay way) {
    return [way](const SceneResult& scene) { return f1_of(scene, way); };
  };
  const auto coverage = [](const SceneResult& s) { return s.of(DriveWay::pipeline).coverage(); };
  return {"F1 over all lists",
          {{"f1", 3, f1(DriveWay::pipeline)},
           {"f1_with_faults", 3, f1(DriveWay::faults)},
           {"cost_of_faults", 3, cost_of_faults},
           {"cost_after_faults", 3, cost_after_faults},
           {"f1_dead_reckoning", 3, f1(DriveWay::dead_reckoning)},
           {"f1_single_sweeps", 3, f1(DriveWay::sweeps)},
           {"coverage", 3, coverage}}};
}

Block pose_block() {
  using Pick = double (*)(const std::vector<double>&);
  using Value = double (*)(const PoseError&);
  const auto each = [](Pick pick, Value value, DriveWay way) {
    return [=](const SceneResult& scene) {
      std::vector<double> all;
      for (const PoseError& error : scene.of(way).pose_errors) all.push_back(value(error));
      return pick(all);
    };
  };
  using enum DriveWay;
  return {
      "Pose at the end of a drive: drift in percent of the way, yaw error in degrees (of more than "
      "a minute: a minute), and a minute if it went on so; with dead reckoning alone beside it",
      {{"way_m", 1, way_driven},
       {"drift_median", 2, each(median_of, drift, pipeline)},
       {"drift_largest", 2, each(largest_of, drift, pipeline)},
       {"reckoned_median", 2, each(median_of, drift, dead_reckoning)},
       {"reckoned_largest", 2, each(largest_of, drift, dead_reckoning)},
       {"yaw_median", 2, each(median_of, yaw, pipeline)},
       {"yaw_largest", 2, each(largest_of, yaw, pipeline)},
       {"yaw_a_minute_largest", 2, each(largest_of, yaw_a_minute, pipeline)},
       {"reckoned_yaw_largest", 2, each(largest_of, yaw, dead_reckoning)}}};
}

Block map_block() {
  const auto rms = [](const SceneResult& s) { return s.surface.rms(); };
  const auto level_rms = [](const SceneResult& s) { return s.level.rms(); };
  const auto points = [](const SceneResult& s) { return static_cast<double>(s.surface.points); };
  const auto grass = [](const SceneResult& s) {
    return static_cast<double>(s.surface.near_volumes);
  };
  return {
      "Map points and the true surface, laid onto it by position and yaw, and by roll and pitch "
      "too; points within 0.1 m of a tuft of grass are left out: blades are no surface",
      {{"map_rms_m", 4, rms},
       {"map_rms_level_m", 4, level_rms},
       {"map_points", 0, points},
       {"near_plants", 0, grass}}};
}

Block warning_block(const std::string& what, const std::string& prefix,
                    WarningDistances ScoringResult::*kind) {
  const auto of = [kind](const SceneResult& s) -> const WarningDistances& {
    return s.large.result().*kind;
  };
  return {
      "Warning distance of " + what + " in metres; none is asked for before it was seen",
      {{prefix, 0, [=](const SceneResult& s) { return static_cast<double>(of(s).obstacles); }},
       {prefix + "_never_found", 0,
        [=](const SceneResult& s) {
          return static_cast<double>(of(s).obstacles - of(s).first.size());
        }},
       {prefix + "_asked_median", 1, [=](const SceneResult& s) { return median_of(of(s).asked); }},
       {prefix + "_first_median", 1, [=](const SceneResult& s) { return median_of(of(s).first); }},
       {prefix + "_first_least", 1, [=](const SceneResult& s) { return least_of(of(s).first); }}}};
}

std::vector<Block> all_blocks() {
  return {detection_block(), pose_block(), map_block(),
          warning_block(fmt::format("rocks of {:g} m and more", kWarnedHeight), "rocks",
                        &ScoringResult::positive_warning),
          warning_block(fmt::format("holes {:g} m and more across", kWarnedWidth), "holes",
                        &ScoringResult::negative_warning)};
}

std::string shown(double value, int decimals, const char* none) {
  return std::isnan(value) ? none : fmt::format("{:.{}f}", value, decimals);
}

std::string text_of(const Block& block, const std::vector<SceneResult>& scenes) {
  std::string text = fmt::format("\n{}\n{:<8}", block.title, "scene");
  for (const Column& column : block.columns) text += fmt::format("  {}", column.name);
  for (const SceneResult& scene : scenes) {
    text += fmt::format("\n{:<8}", name_of(scene.scene));
    for (const Column& column : block.columns) {
      text += fmt::format("  {:>{}}", shown(column.value(scene), column.decimals, "-"),
                          column.name.size());
    }
  }
  return text + "\n";
}

std::string csv_of(const std::vector<Block>& blocks, const std::vector<SceneResult>& scenes) {
  std::string text = "scene";
  for (const Block& block : blocks) {
    for (const Column& column : block.columns) text += fmt::format(",{}", column.name);
  }
  for (const SceneResult& scene : scenes) {
    text += fmt::format("\n{}", name_of(scene.scene));
    for (const Block& block : blocks) {
      for (const Column& column : block.columns) {
        text += fmt::format(",{}", shown(column.value(scene), column.decimals + 2, ""));
      }
    }
  }
  return text + "\n";
}

/// What is asked of every scene but the easiest and the one that mixes them all.
struct Goal {
  std::string column;
  bool is_least;  ///< the value must not be below the bound, else not above it
  double bound;
};

bool is_asked(Scene scene) {
  return scene != Scene::easy && scene != Scene::mixed;
}

std::string goal_line(const Goal& goal, const Column& column,
                      const std::vector<SceneResult>& scenes) {
  const SceneResult* worst = nullptr;
  double worst_value = kNone;
  std::string missed;
  for (const SceneResult& scene : scenes) {
    const double value = column.value(scene);
    if (!is_asked(scene.scene) || std::isnan(value)) continue;
    if (worst == nullptr || (goal.is_least ? value < worst_value : value > worst_value)) {
      worst = &scene;
      worst_value = value;
    }
    const bool is_met = goal.is_least ? value >= goal.bound : value <= goal.bound;
    if (!is_met) missed += fmt::format(" {}", name_of(scene.scene));
  }
  const std::string verdict = worst == nullptr ? "not measured"
                              : missed.empty() ? "met"
                                               : "not met in" + missed;
  return fmt::format("{:<20}  {} {:<5g}  {:>8}  {:<8}  {}\n", goal.column,
                     goal.is_least ? ">=" : "<=", goal.bound,
                     shown(worst_value, column.decimals, "-"),
                     worst == nullptr ? "" : name_of(worst->scene), verdict);
}

std::string goals_of(const std::vector<Block>& blocks, const std::vector<SceneResult>& scenes) {
  const std::vector<Goal> goals = {{"f1", true, 0.97},
                                   {"coverage", true, 1},
                                   {"cost_of_faults", false, 0.05},
                                   {"cost_after_faults", false, 0.05},
                                   {"drift_largest", false, 1},
                                   {"yaw_largest", false, 0.5},
                                   {"map_rms_m", false, 0.03},
                                   {"rocks_first_median", true, 6},
                                   {"holes_first_median", true, 3.5}};
  std::string text = fmt::format("\n{:<20}  {:<8}  {:>8}  {:<8}\n", "goal", "", "worst", "scene");
  for (const Goal& goal : goals) {
    for (const Block& block : blocks) {
      const auto column = std::ranges::find(block.columns, goal.column, &Column::name);
      if (column != block.columns.end()) text += goal_line(goal, *column, scenes);
    }
  }
  return text;
}

std::string heading(const StudyTask& task) {
  const std::size_t drives = task.seeds.count * kScenes.size();
  return fmt::format("{} drives of {:g} s at 0.3 to 2 m/s, {} through each scene, seeds {} to {}",
                     drives, task.seconds, task.seeds.count, task.seeds.first,
                     task.seeds.first + drives - 1);
}

Drawing chart_of(const std::vector<SceneResult>& scenes, const StudyTask& task) {
  BarChart chart;
  chart.title = "F1 on simulated drives, by scene";
  chart.subtitle = heading(task) + "; each obstacle to be found once in each list";
  chart.y = {"F1", 0, 1.05, false};  // room for the numbers over the bars
  chart.decimals = 2;
  for (const SceneResult& scene : scenes) chart.groups.emplace_back(name_of(scene.scene));
  for (std::size_t way = 0; way < kDriveWays; ++way) {
    BarSeries series{std::string(kDriveWayNames[way]), series_colour(way), {}};
    for (const SceneResult& scene : scenes) {
      series.values.push_back(f1_of(scene, static_cast<DriveWay>(way)));
    }
    chart.series.push_back(std::move(series));
  }
  return draw_chart(chart);
}

}  // namespace

void study_drives(const StudyTask& task) {
  const std::vector<SceneResult> scenes = drive_all_scenes(task);
  const std::vector<Block> blocks = all_blocks();
  std::string table = heading(task) + "\n";
  for (const Block& block : blocks) table += text_of(block, scenes);
  write_table(task, "drives.txt", table + goals_of(blocks, scenes));
  write_text(task, "drives.csv", csv_of(blocks, scenes));
  Drawing picture = chart_of(scenes, task);
  write_picture(task, "drives.png", picture);
}

}  // namespace scree::cli
