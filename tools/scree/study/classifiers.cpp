#include <spdlog/fmt/fmt.h>

#include <functional>
#include <optional>

#include "commands.hpp"
#include "common/progress.hpp"
#include "draw/chart.hpp"
#include "scree/learn/back_propagation.hpp"
#include "scree/learn/metrics.hpp"
#include "scree/learn/training.hpp"
#include "study/study.hpp"
#include "training/svm.hpp"

namespace scree::cli {
namespace {

/// A quarter of the area of a whole cloud with three rocks and two holes: the paper has 325
/// obstacles in 65 frames.
TerrainSettings frame() {
  TerrainSettings settings;
  settings.size = 20;
  settings.placed_within = 8.5;
  settings.positive = 3;
  settings.negative = 2;
  settings.smooth = 3;
  settings.pairs = 0;
  return settings;
}

/// The same ground with more on it, so that fewer terrains are needed to learn from.
TerrainSettings crowded() {
  TerrainSettings settings;
  settings.positive = 18;
  settings.negative = 14;
  settings.smooth = 24;
  settings.placed_within = 19;
  return settings;
}

/// Clusters of one way of detecting, in three parts.
struct Parts {
  LabelledClusters training, validation, test;
};

/// Clusters of the same clouds for each way.
std::vector<Parts> gather(const std::vector<Way>& ways, const StudyTask& task) {
  std::vector<Detector> detectors = detectors_of(ways, task);
  std::vector<FindClusters> finders;
  finders.reserve(detectors.size());
  for (Detector& detector : detectors) finders.push_back(finder_of(detector));
  const auto part = [&](const TerrainSettings& settings, std::size_t points, const SeedRange& seeds,
                        const std::string& what) {
    const auto world_of = [&](std::uint64_t seed) { return CloudWorld(settings, points, seed); };
    return label_worlds(finders, world_of, seeds, what);
  };
  // Apart from each other, and from the seeds that any study judges.
  const std::uint64_t first = task.seeds.first + 1'000'000;
  const auto training = part(crowded(), task.points, {first, task.training}, "training");
  const auto validation =
      part(crowded(), task.points, {first + 1'000'000, (task.training + 3) / 4}, "validation");
  const auto test = part(frame(), task.points / 4, task.seeds, "test");
  std::vector<Parts> all;
  for (std::size_t w = 0; w < ways.size(); ++w) {
    all.push_back({training[w], validation[w], test[w]});
  }
  return all;
}

Scores score(std::span<const Sample> samples,
             const std::function<Label(const Features&)>& classify) {
  Scores scores;
  for (const Sample& sample : samples) scores.count(sample.label, classify(sample.features));
  return scores;
}

Score score_network(const Network& network, const Parts& parts, double min_confidence) {
  return evaluate(network, parts.test.samples, min_confidence).all();
}

/// The same network from the same first weights as LM's first start.
Network back_propagated(const Parts& parts, const TrainingSettings& settings) {
  Network network(settings.hidden, settings.inputs);
  fit_normalisation(network, parts.training.samples);
  initialise_weights(network, Random(settings.seed, 0));
  train_back_propagation(network, parts.training.samples, parts.validation.samples);
  return network;
}

/// Cost and width are those that do best on the validation part.
Svm best_svm(const Parts& parts, const Network& normalisation) {
  std::optional<Svm> best;
  double best_f1 = -1;
  for (const double cost : {1.0, 10.0, 100.0}) {
    for (const double width : {0.03, 0.1, 0.3, 1.0}) {
      Svm svm(parts.training.samples, normalisation, {cost, width});
      const double f1 = score(parts.validation.samples, std::cref(svm)).all().f1();
      if (f1 <= best_f1) continue;
      best_f1 = f1;
      best = std::move(svm);
    }
  }
  return *std::move(best);
}

}  // namespace

void study_classifiers(const StudyTask& task) {
  const std::vector<Way> ways = both_ways(task);
  const std::vector<Parts> all = gather(ways, task);
  BarChart chart;
  chart.title = "Classifiers on frames of five obstacles (paper: fig. 21)";
  chart.subtitle = fmt::format(
      "{} simulated frames with {} obstacles; clusters judged, not detections; \"paper's way\": "
      "its chain and F1-F5",
      task.seeds.count, all[0].test.obstacles);
  chart.y = {"share (the axis begins at 0.8)", 0.8, 1, false};
  chart.groups = {"precision", "recall", "F1"};
  std::string table =
      "way,classifier,clusters,obstacles,obstacles_with_cluster,tp,fp,fn,precision,recall,f1\n";
  const auto add = [&](std::size_t w, const std::string& name, const Score& score) {
    table += fmt::format("\"{}\",{},{},{},{},{},{},{},{:.4f},{:.4f},{:.4f}\n", ways[w].name, name,
                         all[w].test.samples.size(), all[w].test.obstacles, all[w].test.found,
                         score.true_positives, score.false_positives, score.false_negatives,
                         score.precision(), score.recall(), score.f1());
    const Colour full = series_colour(chart.series.size() % 3);
    const double tint = w == 0 ? 0.45 : 0;
    chart.series.push_back({fmt::format("{}, {}", name, w == 0 ? "paper's way" : "ours"),
                            {full.red + tint * (1 - full.red), full.green + tint * (1 - full.green),
                             full.blue + tint * (1 - full.blue)},
                            {score.precision(), score.recall(), score.f1()}});
  };
  for (std::size_t w = 0; w < ways.size(); ++w) {
    const Parts& parts = all[w];
    if (parts.training.samples.empty()) {
      throw Failure("the detector found no cluster to train on, see its settings");
    }
    TrainingSettings settings;
    settings.inputs = ways[w].detect.method == Method::surface ? kCloudFeatures : kPaperFeatures;
    const Network trained =
        train_network(parts.training.samples, parts.validation.samples, settings).network;
    const double least = ways[w].detect.min_confidence;
    add(w, "LM-BP", score_network(trained, parts, least));
    add(w, "BPNN", score_network(back_propagated(parts, settings), parts, least));
    const Svm svm = best_svm(parts, trained);
    add(w, "SVM", score(parts.test.samples, std::cref(svm)).all());
  }
  chart.series.push_back({"LM-BP as the paper prints it", kPaperColour, {0.963, 0.988, 0.975}});
  table += "\"paper (fig. 21)\",LM-BP,,325,,,,,0.963,0.988,0.975\n";
  Drawing drawing = draw_chart(chart);
  write_table(task, "classifiers.csv", table);
  write_picture(task, "classifiers.png", drawing);
}

}  // namespace scree::cli
