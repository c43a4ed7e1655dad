#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "draw/study_view.hpp"
#include "scoring/matching.hpp"
#include "scoring/scoring.hpp"
#include "study/study.hpp"

namespace scree::cli {
namespace {

constexpr Colour kGreen{0.0, 0.55, 0.25}, kWrong{0.95, 0.55, 0.0};

void draw(PanelPage& page, int column, const Detector& detector, const CloudWorld& world,
          const ObstacleList& list, const Comparison& comparison, const std::string& title) {
  GroundView view(page.drawing, page.panel(column, 0), world.terrain.half_size(), title);
  const PointCloud& ground = detector.points();
  view.points(ground, 1, [&](std::size_t i) {
    const double light = 0.80 + 0.06 * std::clamp(static_cast<double>(ground.z[i]), -2.0, 2.0);
    return Colour{light, light, light};
  });
  for (const auto& asked : comparison.asked) {
    const TrueObstacle& obstacle = *asked.obstacle;
    view.outline(obstacle.footprint, asked.is_right() ? kGreen : kWrong,
                 asked.is_right() ? 2 : 3.5);
  }
  for (const Obstacle& obstacle : list.obstacles) {
    view.box(obstacle, obstacle.kind == ObstacleKind::positive ? kBlue : kOrange, 2);
  }
  for (const auto& asked : comparison.asked) {
    if (asked.is_right()) continue;
    const TrueObstacle& obstacle = *asked.obstacle;
    const char* what = obstacle.kind == ObstacleKind::positive ? "rock" : "hole";
    view.label(obstacle.center.x(), obstacle.center.y(),
               fmt::format("{} missed: {:+.2f} m", what, obstacle.height), kWrong);
  }
  for (const auto& alarm : comparison.false_alarms) {
    const char* what = alarm.detection->kind == ObstacleKind::positive ? "rock" : "hole";
    view.label(alarm.detection->center.x(), alarm.detection->center.y(), fmt::format("no {}", what),
               kWrong);
  }
}

}  // namespace

void study_result(const StudyTask& task) {
  const std::vector<Way> ways = both_ways(task);
  const CloudWorld world(TerrainSettings(), task.points, task.seeds.first);
  PanelPage page(
      static_cast<int>(ways.size()), 1, "Obstacles found in one cloud (paper: fig. 17, 20)",
      fmt::format("simulated cloud, seed {}: {} points, {} obstacles; the paper's figure 17: 18 "
                  "obstacles, 7 of them negative, one not divided",
                  task.seeds.first, world.cloud.size(), world.truth.visible[0].ids.size()));
  std::string table = "id,kind,shape,height_m,x_m,y_m";
  std::vector<Comparison> comparisons;
  std::vector<ObstacleList> lists;
  for (const Way& way : ways) {
    Detector detector = detector_of(way.detect, task);
    lists.push_back(list_of(detector, world.cloud));
    const ObstacleList& list = lists.back();
    comparisons.push_back(compare(world.truth, world.truth.visible[0], list));
    Scorer scorer;
    scorer.add(world.truth, {&list, 1});
    const Score score = scorer.result().scores.all();
    draw(page, static_cast<int>(comparisons.size()) - 1, detector, world, list, comparisons.back(),
         fmt::format("{}: {} right, {} false, {} missed, F1 {:.3f}", way.name, score.true_positives,
                     score.false_positives, score.false_negatives, score.f1()));
    table += fmt::format(",\"{}\"", way.name);
  }
  table += '\n';
  for (std::size_t i = 0; i < comparisons[0].asked.size(); ++i) {
    const TrueObstacle& obstacle = *comparisons[0].asked[i].obstacle;
    table += fmt::format("{},{},{},{:.2f},{:.2f},{:.2f}", obstacle.id, name(obstacle.kind),
                         obstacle.shape, obstacle.height, obstacle.center.x(), obstacle.center.y());
    for (const Comparison& each : comparisons)
      table += each.asked[i].is_right() ? ",right" : ",missed";
    table += '\n';
  }
  page.legend(kBlue, "found as positive");
  page.legend(kOrange, "found as negative");
  page.legend(kGreen, "true outline, found rightly");
  page.legend(kWrong, "true outline, missed; \"no rock\": a false positive");
  write_table(task, "result.csv", table);
  write_picture(task, "result.png", page.drawing);
}

}  // namespace scree::cli
