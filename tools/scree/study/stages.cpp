#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "draw/study_view.hpp"
#include "study/study.hpp"

namespace scree::cli {
namespace {

struct Stage {
  std::string_view name;
  std::size_t paper;
  std::array<std::size_t, 2> ours;
};

/// Points in colours by their height between these two.
void draw(PanelPage& page, int column, int row, PointView points, const CloudWorld& world,
          std::string_view what, std::size_t paper, std::array<float, 2> bounds) {
  GroundView view(page.drawing, page.panel(column, row), world.terrain.half_size(),
                  fmt::format("{}: {} points (paper: {})", what, points.size(), paper));
  const double pixels = points.size() > 200'000 ? 1 : points.size() > 50'000 ? 1.4 : 1.8;
  view.points(points, pixels, [&](std::size_t i) {
    return height_colour(static_cast<double>((points.z[i] - bounds[0]) / (bounds[1] - bounds[0])));
  });
  for (const TrueObstacle& obstacle : world.truth.obstacles) {
    view.outline(obstacle.footprint, {0, 0, 0, 0.8}, 1);
  }
}

std::array<float, 2> bulk_of(std::span<const float> heights) {
  std::vector<float> sorted(heights.begin(), heights.end());
  std::ranges::sort(sorted);
  const float low = sorted[sorted.size() / 100];
  return {low, std::max(sorted[sorted.size() - 1 - sorted.size() / 100], low + 0.1F)};
}

}  // namespace

void study_stages(const StudyTask& task) {
  const std::vector<Way> ways = both_ways(task);
  const CloudWorld world(TerrainSettings(), task.points, task.seeds.first);
  const auto bounds = bulk_of(world.cloud.z);
  PanelPage page(
      2, 2, "The paper's chain, stage by stage (fig. 10-13)",
      fmt::format("simulated cloud, seed {}; colour is height, {:.1f} m (blue) to {:.1f} m (red); "
                  "black: true outlines",
                  task.seeds.first, static_cast<double>(bounds[0]),
                  static_cast<double>(bounds[1])));
  std::array<Stage, 4> stages = {{{"cloud (fig. 10)", 914'608, {}},
                                  {"after the voxel grid (fig. 11)", 413'591, {}},
                                  {"edges or bodies (fig. 12)", 82'242, {}},
                                  {"after suppression (fig. 13)", 26'011, {}}}};
  for (std::size_t w = 0; w < ways.size(); ++w) {
    Detector detector = detector_of(ways[w].detect, task);
    list_of(detector, world.cloud);
    const StageCounts& counts = detector.counts();
    stages[0].ours[w] = counts.input;
    stages[1].ours[w] = counts.voxels;
    stages[2].ours[w] = counts.candidates;
    stages[3].ours[w] = counts.kept;
    if (w > 0) continue;
    draw(page, 0, 0, world.cloud, world, "cloud", stages[0].paper, bounds);
    draw(page, 1, 0, detector.points(), world, "voxel grid", stages[1].paper, bounds);
    detector.visit_method([&](const auto& method) {
      draw(page, 0, 1, method.candidates().points, world, "edges", stages[2].paper, bounds);
    });
    draw(page, 1, 1, detector.clustered().points.points, world, "after suppression",
         stages[3].paper, bounds);
  }
  std::string table = "stage,paper";
  for (const Way& way : ways) table += fmt::format(",\"{}\"", way.name);
  for (const Stage& stage : stages) {
    table +=
        fmt::format("\n\"{}\",{},{},{}", stage.name, stage.paper, stage.ours[0], stage.ours[1]);
  }
  write_table(task, "stages.csv", table + "\n");
  write_picture(task, "stages.png", page.drawing);
}

}  // namespace scree::cli
