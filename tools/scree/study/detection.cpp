#include <spdlog/fmt/fmt.h>

#include <limits>

#include "commands.hpp"
#include "common/progress.hpp"
#include "detection/score_text.hpp"
#include "draw/chart.hpp"
#include "scree/app/pipeline.hpp"
#include "study/pairs.hpp"
#include "study/study.hpp"

namespace scree::cli {
namespace {

constexpr double kSweepRate = 10;  ///< turns a second

struct CloudScores {
  Scorer scorer;
  Pairs pairs;
};

std::vector<CloudScores> score_clouds(const std::vector<Way>& ways, const StudyTask& task) {
  std::vector<Detector> detectors = detectors_of(ways, task);
  std::vector<CloudScores> scores(ways.size());
  Progress progress("clouds", task.seeds.count);
  for (std::size_t i = 0; i < task.seeds.count; ++i) {
    const CloudWorld world(TerrainSettings(), task.points, task.seeds.first + i);
    for (std::size_t w = 0; w < ways.size(); ++w) {
      const ObstacleList list = list_of(detectors[w], world.cloud);
      scores[w].scorer.add(world.truth, {&list, 1});
      scores[w].pairs.add(world, compare(world.truth, world.truth.visible[0], list));
    }
    progress(i + 1);
  }
  return scores;
}

/// One turn of a lidar at rest, in all scenes.
Scorer score_sweeps(const StudyTask& task) {
  Settings settings = task.settings;
  settings.map.registration = false;  // one sweep does not follow on another
  auto pipeline = Pipeline::make(settings, task.config_file);
  if (!pipeline) throw Failure(pipeline.error().message);
  Scorer scorer;
  Progress progress("sweeps", task.seeds.count);
  for (std::size_t i = 0; i < task.seeds.count; ++i) {
    const SweepWorld world(task.settings.lidar, kSweepRate, task.seeds.first + i);
    scorer.add(world.truth, {&pipeline->process(world.sweep), 1});
    progress(i + 1);
  }
  return scorer;
}

std::string pairs_line(const Pairs& pairs) {
  if (pairs.all == 0) return "\nno pairs in these clouds\n";
  return fmt::format("\npairs 0.3-0.6 m apart that came out as two: {} of {} ({:.1f} %)\n",
                     pairs.parted, pairs.all, 100 * pairs.share_parted());
}

Drawing cloud_chart(const std::vector<Way>& ways, const std::vector<CloudScores>& scores,
                    const StudyTask& task) {
  BarChart chart;
  chart.title = "Detection and kind together on reconstructed clouds";
  chart.subtitle = fmt::format(
      "{} simulated clouds of {} points; each obstacle to be found once, with the right kind",
      task.seeds.count, task.points);
  chart.y = {"share", 0, 1, false};
  chart.groups = {"precision", "recall", "F1", "F1 rocks", "F1 holes", "pairs parted"};
  for (std::size_t w = 0; w < ways.size(); ++w) {
    const Scores& s = scores[w].scorer.result().scores;
    chart.series.push_back({ways[w].name,
                            series_colour(w),
                            {s.all().precision(), s.all().recall(), s.all().f1(), s.positive.f1(),
                             s.negative.f1(), scores[w].pairs.share_parted()}});
  }
  const double none = std::numeric_limits<double>::quiet_NaN();
  chart.series.push_back({"the paper's result on its own 65 frames (fig. 21)",
                          kPaperColour,
                          {0.963, 0.988, 0.975, none, none, none}});
  return draw_chart(chart);
}

Drawing sweep_chart(const ScoringResult& result, const StudyTask& task) {
  LineChart chart;
  chart.title = "Single sweeps, by distance";
  chart.subtitle = fmt::format(
      "{} simulated sweeps of a VLP-16 at rest, {:g} Hz, all scenes, obstacles within 10 m; all "
      "kinds: F1 {:.3f}",
      task.seeds.count, kSweepRate, result.scores.all().f1());
  chart.x = {"distance of the obstacle (false positives: of the detection) [m]", 0, 12, false};
  chart.y = {"share", 0, 1, false};
  chart.lines = {{"precision", series_colour(0), {}, false, true},
                 {"recall", series_colour(1), {}, false, true},
                 {"F1", series_colour(2), {}, false, true}};
  for (const auto& [band, scores] : result.by_range) {
    const Score score = scores.all();
    const double middle = (band + 0.5) * ScoringResult::kRangeBand;
    if (middle > chart.x.high || score.true_positives + score.false_negatives == 0) continue;
    chart.lines[0].points.emplace_back(middle, score.precision());
    chart.lines[1].points.emplace_back(middle, score.recall());
    chart.lines[2].points.emplace_back(middle, score.f1());
  }
  return draw_chart(chart);
}

}  // namespace

void study_detection(const StudyTask& task) {
  const std::vector<Way> ways = both_ways(task);
  const std::vector<CloudScores> clouds = score_clouds(ways, task);
  const Scorer sweeps = score_sweeps(task);
  std::string table;
  for (std::size_t w = 0; w < ways.size(); ++w) {
    table += fmt::format("== {} clouds, {} ==\n", task.seeds.count, ways[w].name) +
             score_table(clouds[w].scorer.result()) + pairs_line(clouds[w].pairs) + "\n";
  }
  table += fmt::format("== {} single sweeps, Scree, as configured ==\n", task.seeds.count) +
           score_table(sweeps.result());
  write_table(task, "detection.txt", table);
  Drawing cloud_picture = cloud_chart(ways, clouds, task);
  write_picture(task, "detection.png", cloud_picture);
  Drawing sweep_picture = sweep_chart(sweeps.result(), task);
  write_picture(task, "detection-sweeps.png", sweep_picture);
}

}  // namespace scree::cli
