#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "common/progress.hpp"
#include "draw/chart.hpp"
#include "scree/learn/back_propagation.hpp"
#include "scree/learn/training.hpp"
#include "study/study.hpp"

namespace scree::cli {
namespace {

constexpr int kIterations = 2000;

struct Curve {
  std::string name;
  std::vector<TrainingStep> steps;
};

/// All methods from the same weights. Without validation samples none of them stops early.
std::vector<Curve> train_all(const std::vector<Sample>& samples) {
  Network start(TrainingSettings().hidden, kPaperFeatures);
  fit_normalisation(start, samples);
  initialise_weights(start, Random(1));
  std::vector<Curve> curves;
  Network network = start;
  LevenbergMarquardtSettings settings;
  settings.max_iterations = kIterations;
  curves.push_back(
      {"Levenberg-Marquardt", train_levenberg_marquardt(network, samples, {}, settings).curve});
  Progress progress("back-propagation", 2);
  std::size_t done = 0;
  for (const double momentum : {0.0, 0.9}) {
    network = start;
    BackPropagationSettings plain;
    plain.momentum = momentum;
    plain.iterations = kIterations;
    curves.push_back({momentum > 0 ? fmt::format("back-propagation with momentum {:g}", momentum)
                                   : "back-propagation",
                      train_back_propagation(network, samples, {}, plain).curve});
    progress(++done);
  }
  return curves;
}

std::string table_of(const std::vector<Curve>& curves) {
  std::string text = "iteration";
  for (const Curve& curve : curves) text += "," + curve.name;
  for (const int at : {0, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000}) {
    text += fmt::format("\n{}", at);
    for (const Curve& curve : curves) {
      const auto i = std::min(static_cast<std::size_t>(at), curve.steps.size() - 1);
      text += fmt::format(",{:.6f}", curve.steps[i].training_error);
    }
  }
  return text + "\n";
}

}  // namespace

void study_training(const StudyTask& task) {
  Settings settings = task.settings;
  settings.detect_cloud = DetectSettings::for_paper();
  LabelledClusters clusters;
  {
    Progress progress("clusters", task.seeds.count);
    clusters = make_data_set(Profile::cloud, settings, task.seeds, std::ref(progress));
  }
  const std::vector<Curve> curves = train_all(clusters.samples);

  LineChart chart;
  chart.title = "Training: Levenberg-Marquardt against back-propagation (paper: fig. 7)";
  chart.subtitle = fmt::format(
      "{} clusters of {} simulated clouds, F1-F5, the same first weights; the paper prints curves "
      "but no numbers",
      clusters.samples.size(), task.seeds.count);
  double least = 1, most = 0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    ChartLine line{curves[i].name, series_colour(i), {}, i == 2, false};
    for (std::size_t step = 1; step < curves[i].steps.size(); ++step) {
      const double error = std::max(curves[i].steps[step].training_error, 1e-12);
      line.points.emplace_back(static_cast<double>(step), error);
      least = std::min(least, error);
      most = std::max(most, error);
    }
    // Where it ended by itself it stays.
    line.points.emplace_back(kIterations, line.points.empty() ? 1 : line.points.back().y());
    chart.lines.push_back(std::move(line));
  }
  chart.x = {"iteration (each over all samples)", 1, kIterations, true};
  chart.y = {"mean squared error", std::pow(10, std::floor(std::log10(least))),
             std::max(std::pow(10, std::ceil(std::log10(most))), 1e-11), true};
  Drawing drawing = draw_chart(chart);
  write_table(task, "training.csv", table_of(curves));
  write_picture(task, "training.png", drawing);
}

}  // namespace scree::cli
