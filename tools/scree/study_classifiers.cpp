#include <spdlog/fmt/fmt.h>

#include <functional>
#include <optional>

#include "chart.hpp"
#include "commands.hpp"
#include "progress.hpp"
#include "scree/learn/back_propagation.hpp"
#include "scree/learn/metrics.hpp"
#include "scree/learn/training.hpp"
#include "study.hpp"
#include "svm.hpp"

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
struct Samples {
  std::vector<Sample> training, validation, test;
  std::size_t obstacles = 0, found = 0;  ///< of the test part
};

/// Clusters of the same clouds for each way.
std::vector<Samples> gather(const std::vector<Way>& ways, const StudyTask& task) {
  std::vector<Detector> detectors = detectors_of(ways, task);
  std::vector<Samples> all(ways.size());
  const auto each_cloud = [&](const TerrainSettings& settings, std::size_t points, SeedRange seeds,
                              const std::string& what, auto&& take) {
    Progress progress("clusters for " + what, seeds.count);
    for (std::size_t i = 0; i < seeds.count; ++i) {
      const CloudWorld world(settings, points, seeds.first + i);
      for (std::size_t w = 0; w < ways.size(); ++w) {
        list_of(detectors[w], world.cloud, ways[w].detect);
        take(all[w],
             label_clusters(detectors[w], world.terrain.features(), world.truth.visible[0].ids));
      }
      progress(i + 1);
    }
  };
  const auto append = [](std::vector<Sample>& to, const LabelledClusters& clusters) {
    to.insert(to.end(), clusters.samples.begin(), clusters.samples.end());
  };
  // Apart from each other, and from the seeds that any study judges.
  const std::uint64_t training = task.seeds.first + 1'000'000;
  const std::uint64_t validation = training + 1'000'000;
  each_cloud(crowded(), task.points, {training, task.training}, "training",
             [&](Samples& samples, const LabelledClusters& clusters) {
               append(samples.training, clusters);
             });
  each_cloud(crowded(), task.points, {validation, (task.training + 3) / 4}, "validation",
             [&](Samples& samples, const LabelledClusters& clusters) {
               append(samples.validation, clusters);
             });
  each_cloud(frame(), task.points / 4, task.seeds, "test",
             [&](Samples& samples, const LabelledClusters& clusters) {
               append(samples.test, clusters);
               samples.obstacles += clusters.obstacles;
               samples.found += clusters.found;
             });
  return all;
}

Scores judge(std::span<const Sample> samples, const std::function<Label(const Features&)>& answer) {
  Scores scores;
  for (const Sample& sample : samples) scores.count(sample.label, answer(sample.features));
  return scores;
}

Score score_network(const Network& network, const Samples& samples, double min_confidence) {
  return evaluate(network, samples.test, min_confidence).all();
}

/// The same network from the same first weights as LM's first start.
Network back_propagated(const Samples& samples, const TrainingSettings& settings) {
  Network network(settings.hidden, settings.inputs);
  fit_normalisation(network, samples.training);
  initialise_weights(network, Random(settings.seed, 0));
  train_back_propagation(network, samples.training, samples.validation);
  return network;
}

/// Cost and width are those that do best on the validation part.
Svm best_svm(const Samples& samples, const Network& normalisation) {
  std::optional<Svm> best;
  double best_f1 = -1;
  for (const double cost : {1.0, 10.0, 100.0}) {
    for (const double width : {0.03, 0.1, 0.3, 1.0}) {
      Svm svm(samples.training, normalisation, {cost, width});
      const double f1 = judge(samples.validation, std::cref(svm)).all().f1();
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
  const std::vector<Samples> all = gather(ways, task);
  BarChart chart;
  chart.title = "Classifiers on frames of five obstacles (paper: fig. 21)";
  chart.subtitle = fmt::format(
      "{} simulated frames with {} obstacles; clusters judged, not detections; \"paper's way\": "
      "its chain and F1-F5",
      task.seeds.count, all[0].obstacles);
  chart.y = {"share (the axis begins at 0.8)", 0.8, 1, false};
  chart.groups = {"precision", "recall", "F1"};
  std::string table =
      "way,classifier,clusters,obstacles,obstacles_with_cluster,tp,fp,fn,precision,recall,f1\n";
  const auto add = [&](std::size_t w, const std::string& name, const Score& score) {
    table += fmt::format("\"{}\",{},{},{},{},{},{},{},{:.4f},{:.4f},{:.4f}\n", ways[w].name, name,
                         all[w].test.size(), all[w].obstacles, all[w].found, score.true_positives,
                         score.false_positives, score.false_negatives, score.precision(),
                         score.recall(), score.f1());
    const Colour full = series_colour(chart.series.size() % 3);
    const double tint = w == 0 ? 0.45 : 0;
    chart.series.push_back({fmt::format("{}, {}", name, w == 0 ? "paper's way" : "ours"),
                            {full.red + tint * (1 - full.red), full.green + tint * (1 - full.green),
                             full.blue + tint * (1 - full.blue)},
                            {score.precision(), score.recall(), score.f1()}});
  };
  for (std::size_t w = 0; w < ways.size(); ++w) {
    const Samples& samples = all[w];
    if (samples.training.empty()) {
      throw Failure("the detector found no cluster to train on, see its settings");
    }
    TrainingSettings settings;
    settings.inputs = ways[w].detect.uses_surface() ? kFeatures : kPaperFeatures;
    const Network trained = train_network(samples.training, samples.validation, settings).network;
    const double least = ways[w].detect.min_confidence;
    add(w, "LM-BP", score_network(trained, samples, least));
    add(w, "BPNN", score_network(back_propagated(samples, settings), samples, least));
    const Svm svm = best_svm(samples, trained);
    add(w, "SVM", judge(samples.test, std::cref(svm)).all());
  }
  chart.series.push_back({"LM-BP as the paper prints it", kPaperColour, {0.963, 0.988, 0.975}});
  table += "\"paper (fig. 21)\",LM-BP,,325,,,,,0.963,0.988,0.975\n";
  Drawing drawing = draw_chart(chart);
  write_table(task, "classifiers.csv", table);
  write_picture(task, "classifiers.png", drawing);
}

}  // namespace scree::cli
