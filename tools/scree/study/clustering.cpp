#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "common/progress.hpp"
#include "draw/study_view.hpp"
#include "study/study.hpp"

namespace scree::cli {
namespace {

constexpr int kColumns = 3;  // of the picture
/// The paper's share of points that are steep enough (fig. 11, 12).
constexpr double kPaperEdgeShare = 82'242.0 / 413'591;

/// The threshold that keeps this share of a cloud's points.
double threshold_for(const SlopedCloud& sloped, double share) {
  std::vector<float> slopes;
  for (std::size_t i = 0; i < sloped.size(); ++i) {
    if (!sloped.is_known(i)) continue;
    slopes.push_back(std::hypot(sloped.slope_x[i], sloped.slope_y[i]));
  }
  if (slopes.empty()) return 0;
  const auto rank =
      static_cast<std::ptrdiff_t>((1 - share) * static_cast<double>(slopes.size() - 1));
  std::nth_element(slopes.begin(), slopes.begin() + rank, slopes.end());
  return static_cast<double>(slopes[static_cast<std::size_t>(rank)]);
}

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
void compare(const ClusteredPoints& found, const CloudWorld& world, Fit& fit) {
  constexpr double kGrowth = 0.15;
  const auto clusters = found.clusters.all();
  const PointCloud& points = found.points.points;
  std::vector<std::vector<std::size_t>> homes;          // clusters of each obstacle
  std::vector<std::size_t> guests(clusters.size(), 0);  // obstacles of each cluster
  for (const int id : obstacle_ids(world.terrain)) {
    const auto& features = world.terrain.features();
    const auto feature = std::ranges::find(features, id, &TerrainFeature::id);
    std::map<std::size_t, std::size_t> shares;
    std::size_t all = 0;
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      for (const std::uint32_t i : found.clusters.members(clusters[c])) {
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

void draw(PanelPage& page, std::size_t number, const ClusteredPoints& found,
          const CloudWorld& world, const std::string& name) {
  const auto clusters = found.clusters.all();
  GroundView view(
      page.drawing,
      page.panel(static_cast<int>(number) % kColumns, static_cast<int>(number) / kColumns),
      world.terrain.half_size(), fmt::format("{}: {} clusters", name, clusters.size()));
  const PointCloud& points = found.points.points;
  std::vector<Colour> colours(points.size(), Colour{0.8, 0.8, 0.82});
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    for (const std::uint32_t i : found.clusters.members(clusters[c])) {
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
  std::vector<Way> ways = {
      {"plain Euclidean", DetectSettings::for_paper()},
      {"super-voxels", DetectSettings::for_paper()},
      {"Scree, as configured", task.settings.detect_cloud},
      {"plain Euclidean, edges as many as the paper's", DetectSettings::for_paper()},
      {"super-voxels, edges as many as the paper's", DetectSettings::for_paper()}};
  ways[0].detect.edges.clustering = ways[3].detect.edges.clustering = EdgeClustering::euclidean;
  constexpr std::size_t kFirstOfPaperShare = 3;
  std::vector<Fit> fits(ways.size());
  PanelPage page(kColumns, 2, "Clusters of one cloud (paper: fig. 14 and 16)",
                 fmt::format("seed {}; the paper: 5 clusters by plain Euclidean clustering, 18 by "
                             "super-voxels, for 18 obstacles",
                             task.seeds.first));
  {
    Progress progress("clouds", task.seeds.count);
    for (std::size_t i = 0; i < task.seeds.count; ++i) {
      const CloudWorld world(TerrainSettings(), task.points, task.seeds.first + i);
      double threshold = 0;
      for (std::size_t w = 0; w < ways.size(); ++w) {
        DetectSettings settings = ways[w].detect;
        if (w >= kFirstOfPaperShare) settings.edges.threshold = threshold;
        Detector detector = detector_of(settings, task);
        list_of(detector, world.cloud);
        if (w == 0) threshold = threshold_for(detector.edge_method()->sloped(), kPaperEdgeShare);
        compare(detector.clustered(), world, fits[w]);
        if (i == 0) draw(page, w, detector.clustered(), world, ways[w].name);
      }
      progress(i + 1);
    }
  }
  page.legend({0, 0, 0}, "true outline");
  page.legend({0.8, 0.8, 0.82}, "point of a group too small for a cluster");
  page.legend(scattered_colour(0), "any other colour: one cluster");

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
