#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>

#include "progress.hpp"
#include "study.hpp"
#include "study_view.hpp"

namespace scree::cli {
namespace {

/// How the clusters of some clouds fit their obstacles.
struct Fit {
  std::size_t obstacles = 0;
  std::size_t clusters = 0;
  std::size_t merged = 0;    ///< obstacles that share a cluster with another one
  std::size_t split = 0;     ///< obstacles in several clusters
  std::size_t missed = 0;    ///< obstacles in none
  std::size_t separate = 0;  ///< in one cluster of their own
};

/// An obstacle is in a cluster that has a tenth of its clustered points, and at least five.
void judge(const Detector& detector, const CloudWorld& world, Fit& fit) {
  constexpr double kGrowth = 0.15;
  const auto clusters = detector.clusters().all();
  const PointCloud& points = detector.kept().points;
  std::vector<std::vector<std::size_t>> homes;          // clusters of each obstacle
  std::vector<std::size_t> guests(clusters.size(), 0);  // obstacles of each cluster
  for (const int id : obstacle_ids(world.terrain)) {
    const auto& features = world.terrain.features();
    const auto feature = std::ranges::find(features, id, &TerrainFeature::id);
    std::map<std::size_t, std::size_t> shares;
    std::size_t all = 0;
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      for (const std::uint32_t i : detector.clusters().members(clusters[c])) {
        const Eigen::Vector2d at(static_cast<double>(points.x[i]),
                                 static_cast<double>(points.y[i]));
        if (distance(feature->footprint, at) > kGrowth) continue;
        ++shares[c];
        ++all;
      }
    }
    std::erase_if(shares,
                  [&](const auto& each) { return each.second < 5 || 10 * each.second < all; });
    homes.emplace_back();
    for (const auto& [cluster, count] : shares) {
      homes.back().push_back(cluster);
      ++guests[cluster];
    }
  }
  fit.clusters += clusters.size();
  fit.obstacles += homes.size();
  for (const auto& home : homes) {
    const bool is_merged = std::ranges::any_of(home, [&](std::size_t c) { return guests[c] > 1; });
    fit.merged += is_merged ? 1U : 0U;
    fit.split += home.size() > 1 ? 1U : 0U;
    fit.missed += home.empty() ? 1U : 0U;
    fit.separate += home.size() == 1 && !is_merged ? 1U : 0U;
  }
}

void draw(PanelPage& page, int column, const Detector& detector, const CloudWorld& world,
          const std::string& name) {
  const auto clusters = detector.clusters().all();
  GroundView view(page.drawing, page.panel(column, 0), world.terrain.half_size(),
                  fmt::format("{}: {} clusters", name, clusters.size()));
  const PointCloud& points = detector.kept().points;
  std::vector<Colour> colours(points.size(), Colour{0.8, 0.8, 0.82});
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    for (const std::uint32_t i : detector.clusters().members(clusters[c])) {
      colours[i] = scattered_colour(c);
    }
  }
  view.points(points, 2, [&](std::size_t i) { return colours[i]; });
  for (const TrueObstacle& obstacle : world.truth.obstacles) {
    if (std::ranges::count(world.truth.visible[0].ids, obstacle.id) == 0) continue;
    view.outline(obstacle.footprint, {0, 0, 0}, 1.4);
  }
}

}  // namespace

void study_clustering(const StudyTask& task) {
  std::vector<Way> ways = {{"plain Euclidean", DetectSettings::for_paper()},
                           {"super-voxels", DetectSettings::for_paper()},
                           {"Scree, as configured", task.settings.detect_cloud}};
  ways[0].detect.cluster_method = ClusterMethod::euclidean;
  ways[1].detect.cluster_method = ClusterMethod::supervoxel;
  std::vector<Detector> detectors;
  for (const Way& way : ways) detectors.push_back(detector_of(way.detect, task));
  std::vector<Fit> fits(ways.size());
  PanelPage page(static_cast<int>(ways.size()), 1, "Clusters of one cloud (paper: fig. 14 and 16)",
                 fmt::format("seed {}; the paper: 5 clusters by plain Euclidean clustering, 18 by "
                             "super-voxels, for 18 obstacles",
                             task.seeds.first));
  {
    Progress progress("clouds", task.seeds.count);
    for (std::size_t i = 0; i < task.seeds.count; ++i) {
      const CloudWorld world(TerrainSettings(), task.points, task.seeds.first + i);
      for (std::size_t w = 0; w < ways.size(); ++w) {
        list_of(detectors[w], world.cloud, ways[w].detect);
        judge(detectors[w], world, fits[w]);
        if (i == 0) draw(page, static_cast<int>(w), detectors[w], world, ways[w].name);
      }
      progress(i + 1);
    }
  }
  page.legend({0, 0, 0}, "true outline");
  page.legend({0.8, 0.8, 0.82}, "clustered point of a removed group");
  page.legend(scattered_colour(0), "other colours: a cluster each");

  std::string table = "method,clouds,clusters,obstacles,separate,merged,split,missed\n";
  for (std::size_t w = 0; w < ways.size(); ++w) {
    const Fit& fit = fits[w];
    table +=
        fmt::format("\"{}\",{},{},{},{},{},{},{}\n", ways[w].name, task.seeds.count, fit.clusters,
                    fit.obstacles, fit.separate, fit.merged, fit.split, fit.missed);
  }
  table +=
      "\"paper, plain Euclidean (fig. 14)\",1,5,18,,,,\n"
      "\"paper, super-voxels (fig. 16)\",1,18,18,,,,\n";
  write_table(task, "clustering.csv", table);
  write_picture(task, "clustering.png", page.drawing);
}

}  // namespace scree::cli
