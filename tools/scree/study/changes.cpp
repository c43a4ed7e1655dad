#include <spdlog/fmt/fmt.h>

#include <ctime>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "common/progress.hpp"
#include "draw/chart.hpp"
#include "scoring/scoring.hpp"
#include "scree/detect/classification.hpp"
#include "scree/learn/training.hpp"
#include "study/pairs.hpp"
#include "study/rung.hpp"
#include "study/study.hpp"

namespace scree::cli {
namespace {

/// A way of detecting, and how many of the features its network is told.
struct Rung {
  std::string name;
  DetectSettings detect;
  std::size_t inputs = kPaperFeatures;
  std::optional<SurfaceRung::Candidates> in_between;  ///< neither method alone, see SurfaceRung
};

/// From the paper's method to ours, each with one change more than the one before; then two beside
/// the ladder.
std::vector<Rung> ladder() {
  Rung rung{"the paper's method", DetectSettings::for_paper(), kPaperFeatures, {}};
  DetectSettings& detect = rung.detect;
  std::vector<Rung> rungs = {rung};
  const auto climb = [&](const std::string& name) {
    rung.name = name;
    rungs.push_back(rung);
  };
  detect.edges.kernel.bandwidth = detect.surface.kernel.bandwidth = 0.5;
  climb("+ narrower kernel");
  detect.edges.suppression = false;
  climb("+ no suppression");
  rung.in_between = SurfaceRung::Candidates::steep;
  climb("+ heights above the ground's surface");
  rung.in_between.reset();
  detect.method = Method::surface;
  climb("+ bodies instead of edge points");
  rung.inputs = kCloudFeatures;
  climb("+ all features");
  rungs.push_back({"beside it: as shipped", DetectSettings::for_cloud(), kCloudFeatures, {}});
  rung.in_between = SurfaceRung::Candidates::off_ground;
  detect.edges.voxel_size = 0.06;
  detect.edges.seed_distance = 0.12;
  // So small a block holds hardly more than four thinned points.
  detect.edges.min_block_points = 1;
  detect.edges.cluster_tolerance = detect.surface.cluster_tolerance;
  detect.edges.min_cluster_size = detect.surface.min_cluster_size;
  climb("beside it: super-voxels");
  return rungs;
}

CloudWorld varied_world(std::uint64_t seed) {
  return {varied_terrain(seed), varied_cloud(seed), seed};
}

FindClusters finder_of_rung(const Rung& rung) {
  const DetectorLimits limits = MemorySettings().for_cloud();
  if (rung.in_between) {
    auto between = std::make_shared<SurfaceRung>(rung.detect, limits, *rung.in_between);
    return [between](PointView cloud) { return between->find(cloud); };
  }
  auto detector = std::make_shared<Detector>(rung.detect, limits, Network());
  return [detector](PointView cloud) { return finder_of(*detector)(cloud); };
}

std::vector<FindClusters> finders_of(const std::vector<Rung>& rungs) {
  std::vector<FindClusters> finders;
  finders.reserve(rungs.size());
  for (const Rung& rung : rungs) finders.push_back(finder_of_rung(rung));
  return finders;
}

/// A network for each rung, which has learnt from the clusters that the rung finds.
std::vector<Network> train_each(const std::vector<Rung>& rungs,
                                std::span<const FindClusters> finders, const SeedRange& training,
                                const SeedRange& validation) {
  const auto learnt = label_worlds(finders, varied_world, training, "training");
  const auto watched = label_worlds(finders, varied_world, validation, "validation");
  std::vector<Network> networks;
  for (std::size_t r = 0; r < rungs.size(); ++r) {
    if (learnt[r].samples.empty()) throw Failure(rungs[r].name + ": no cluster to train on");
    TrainingSettings settings;
    settings.inputs = rungs[r].inputs;
    networks.push_back(train_network(learnt[r].samples, watched[r].samples, settings).network);
  }
  return networks;
}

/// What a rung reached on the clouds that judge it.
struct Outcome {
  Scorer scorer;
  Pairs pairs;
  LabelledClusters clusters;
  std::vector<double> milliseconds;

  void add(const FindClusters& find, const Network& network, double min_confidence,
           const CloudWorld& world) {
    const std::clock_t begin = std::clock();
    const ClusteredPoints found = find(world.cloud);
    ObstacleList list(static_cast<std::size_t>(MemorySettings().obstacles));
    EnclosingPolygons polygons(found.points.size());
    StageCounts unused;
    classify(found, network, min_confidence, Eigen::Vector2f::Zero(), polygons, list.obstacles,
             unused);
    milliseconds.push_back(1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    scorer.add(world.truth, {&list, 1});
    pairs.add(world, compare(world.truth, world.truth.visible[0], list));
    clusters += label_clusters(found, world.terrain.features(), world.truth.visible[0].ids);
  }
};

std::vector<Outcome> score_each(const std::vector<Rung>& rungs,
                                std::span<const FindClusters> finders,
                                const std::vector<Network>& networks, const SeedRange& seeds) {
  std::vector<Outcome> outcomes(rungs.size());
  Progress progress("clouds", seeds.count);
  for (std::size_t i = 0; i < seeds.count; ++i) {
    const CloudWorld world = varied_world(seeds.first + i);
    for (std::size_t r = 0; r < rungs.size(); ++r) {
      outcomes[r].add(finders[r], networks[r], rungs[r].detect.min_confidence, world);
    }
    progress(i + 1);
  }
  return outcomes;
}

}  // namespace

void study_changes(const StudyTask& task) {
  // Apart from what any other study trains on or judges.
  const SeedRange judged{task.seeds.first + 3'000'000, task.seeds.count};
  const SeedRange training{task.seeds.first + 4'000'000, task.training};
  const SeedRange validation{task.seeds.first + 5'000'000, (2 * task.training + 4) / 5};
  const std::vector<Rung> rungs = ladder();
  const std::vector<FindClusters> finders = finders_of(rungs);
  const std::vector<Network> networks = train_each(rungs, finders, training, validation);
  const std::vector<Outcome> outcomes = score_each(rungs, finders, networks, judged);

  BarChart chart;
  chart.title = "What each change to the paper's method brought";
  chart.subtitle = fmt::format(
      "detection and kind together on {} simulated clouds of all scenes; each with a network of "
      "its own, trained on {} clouds",
      judged.count, training.count);
  chart.y = {"percent", 0, 107, false};  // with room for the numbers
  chart.decimals = 1;
  chart.groups = {"F1", "F1 rocks", "F1 holes", "close pairs parted"};
  std::string table =
      "way,precision,recall,f1,f1_rocks,f1_holes,pairs,pairs_parted,clusters,clusters_f1,"
      "median_ms_noisy\n";
  for (std::size_t r = 0; r < rungs.size(); ++r) {
    const Outcome& outcome = outcomes[r];
    const Scores& scores = outcome.scorer.result().scores;
    const Score all = scores.all();
    const double alone =
        evaluate(networks[r], outcome.clusters.samples, rungs[r].detect.min_confidence).all().f1();
    table +=
        fmt::format("\"{}\",{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{},{},{},{:.4f},{:.0f}\n",
                    rungs[r].name, all.precision(), all.recall(), all.f1(), scores.positive.f1(),
                    scores.negative.f1(), outcome.pairs.all, outcome.pairs.parted,
                    outcome.clusters.samples.size(), alone, median(outcome.milliseconds));
    chart.series.push_back({rungs[r].name,
                            series_colour(r),
                            {100 * all.f1(), 100 * scores.positive.f1(), 100 * scores.negative.f1(),
                             100 * outcome.pairs.share_parted()}});
  }
  Drawing drawing = draw_chart(chart);
  write_table(task, "changes.csv", table);
  write_picture(task, "changes.png", drawing);
}

}  // namespace scree::cli
