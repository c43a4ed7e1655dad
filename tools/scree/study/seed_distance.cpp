#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>

#include "common/progress.hpp"
#include "draw/chart.hpp"
#include "scoring/scoring.hpp"
#include "study/study.hpp"

namespace scree::cli {
namespace {

constexpr std::array kDistances = {0.05, 0.10, 0.15, 0.20, 0.25, 0.30, 0.40, 0.50, 0.70};

/// Blocks are made of voxels: these have to be smaller.
DetectSettings with_seed_distance(DetectSettings settings, double distance) {
  EdgeSettings& edges = settings.edges;
  edges.seed_distance = distance;
  edges.voxel_size = std::min(edges.voxel_size, distance / 2);
  return settings;
}

}  // namespace

void study_seed_distance(const StudyTask& task) {
  struct Case {
    std::string name;
    DetectSettings detect;
    std::array<Scorer, kDistances.size()> scorers;
  };
  std::vector<Case> cases(2);
  const DetectSettings paper = DetectSettings::for_paper();
  cases[0] = {
      fmt::format("paper's chain, blocks of {} points and more", paper.edges.min_block_points),
      paper,
      {}};
  cases[1] = {"paper's chain, blocks of one point and more", paper, {}};
  cases[1].detect.edges.min_block_points = 1;
  {
    Progress progress("clouds", task.seeds.count);
    for (std::size_t i = 0; i < task.seeds.count; ++i) {
      const CloudWorld world(TerrainSettings(), task.points, task.seeds.first + i);
      for (Case& each : cases) {
        for (std::size_t d = 0; d < kDistances.size(); ++d) {
          const DetectSettings settings = with_seed_distance(each.detect, kDistances[d]);
          Detector detector = detector_of(settings, task);
          const ObstacleList list = list_of(detector, world.cloud);
          each.scorers[d].add(world.truth, {&list, 1});
        }
      }
      progress(i + 1);
    }
  }
  LineChart chart;
  chart.title = "F1 over the size of super-voxels (paper: fig. 15)";
  chart.subtitle = fmt::format(
      "{} simulated clouds of {} points, detection and kind together; voxels of {:g} m or half the "
      "size",
      task.seeds.count, task.points, paper.edges.voxel_size);
  chart.x = {"Rseed, size of a super-voxel [m]", 0, 0.75, false};
  chart.y = {"F1", 0, 1, false};
  std::string table = "rseed_m";
  for (std::size_t c = 0; c < cases.size(); ++c) {
    table += fmt::format(",\"F1, {}\"", cases[c].name);
    chart.lines.push_back({cases[c].name, series_colour(c), {}, false, true});
  }
  table += '\n';
  for (std::size_t d = 0; d < kDistances.size(); ++d) {
    table += fmt::format("{:g}", kDistances[d]);
    for (std::size_t c = 0; c < cases.size(); ++c) {
      const double f1 = cases[c].scorers[d].result().scores.all().f1();
      chart.lines[c].points.emplace_back(kDistances[d], f1);
      table += fmt::format(",{:.4f}", f1);
    }
    table += '\n';
  }
  chart.lines.push_back({"the paper's choice: 0.05 m, on its own cloud (it prints no F1 values)",
                         kPaperColour,
                         {{0.05, 0}, {0.05, 1}},
                         true,
                         false});
  Drawing drawing = draw_chart(chart);
  write_table(task, "seed-distance.csv", table);
  write_picture(task, "seed-distance.png", drawing);
}

}  // namespace scree::cli
