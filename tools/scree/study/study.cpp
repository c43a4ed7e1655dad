#include "study/study.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <memory>

#include "commands.hpp"
#include "common/outputs.hpp"
#include "common/progress.hpp"
#include "common/usage_error.hpp"
#include "scree/app/pipeline.hpp"
#include "simulator/scene.hpp"

namespace scree::cli {
namespace {

struct Study {
  std::string_view name, what;
  std::size_t seeds;
  void (*run)(const StudyTask&);
};

constexpr std::array<Study, 9> kStudies = {{
    {"training", "Levenberg-Marquardt against back-propagation (fig. 7)", 10, study_training},
    {"clustering", "plain Euclidean against super-voxel clustering (fig. 14, 16)", 20,
     study_clustering},
    {"seed-distance", "F1 over the size of super-voxels (fig. 15)", 8, study_seed_distance},
    {"stages", "points from stage to stage (fig. 10-13)", 1, study_stages},
    {"result", "what is found in one cloud (fig. 17, 20)", 1, study_result},
    {"classifiers", "LM-BP, BPNN and SVM on frames of five obstacles (fig. 21)", 65,
     study_classifiers},
    {"changes", "what each change to the paper's method brought", 24, study_changes},
    {"detection", "detection and kind together, clouds and single sweeps", 65, study_detection},
    {"drives", "simulated drives through every scene against the goals; seeds are those of a scene",
     4, study_drives},
}};

/// Beyond the seeds of `scree train`, so that no study meets a terrain that weights came from.
constexpr std::uint64_t kFirstSeed = 900'001;

struct StudyOptions {
  std::string name, config;
  std::string out;
  std::size_t seeds = 0, training = 40, points = CloudSettings().points;
  std::uint64_t seed = kFirstSeed;
  double seconds = 15;
  Outputs outputs;
};

std::string listing() {
  std::string text;
  for (const Study& study : kStudies) {
    text += fmt::format("\n  {:<14} {}; {} seeds", study.name, study.what, study.seeds);
  }
  return text;
}

/// The files of a study are those that begin with its name: others may be in the folder, too.
void require_free(const StudyOptions& options) {
  for (const auto& entry : std::filesystem::directory_iterator(options.out)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(options.name + ".") || name.starts_with(options.name + "-")) {
      options.outputs.require_free({entry.path()});
    }
  }
}

void run(const StudyOptions& options) {
  StudyTask task;
  task.out = options.out;
  task.settings.lidar = scene_lidar();
  if (!options.config.empty()) {
    const auto loaded = load_settings(options.config);
    if (!loaded) throw Failure(loaded.error().message);
    task.settings = *loaded;
    // A file of settings alone has no robot; a lidar on the ground would see none of it.
    if (loaded->lidar.translation.isZero()) {
      task.settings.lidar.translation = scene_lidar().translation;
    }
    task.config_file = options.config;
  }
  std::error_code failed;
  std::filesystem::create_directories(task.out, failed);
  if (failed) throw Failure("cannot make the folder " + options.out + ": " + failed.message());
  require_free(options);
  require_cairo();
  task.training = options.training;
  task.points = options.points;
  task.seconds = options.seconds;
  for (const Study& study : kStudies) {
    if (study.name != options.name) continue;
    task.seeds = {options.seed, options.seeds > 0 ? options.seeds : study.seeds};
    study.run(task);
  }
}

}  // namespace

std::vector<Way> both_ways(const StudyTask& task) {
  return {{"paper, as printed", DetectSettings::for_paper()},
          {"Scree, as configured", task.settings.detect_cloud}};
}

Detector detector_of(const DetectSettings& settings, const StudyTask& task) {
  auto detector = make_detector(settings, task.settings.memory.for_cloud(), task.config_file);
  if (!detector) throw Failure(detector.error().message);
  return *std::move(detector);
}

std::vector<Detector> detectors_of(const std::vector<Way>& ways, const StudyTask& task) {
  std::vector<Detector> detectors;
  detectors.reserve(ways.size());
  for (const Way& way : ways) detectors.push_back(detector_of(way.detect, task));
  return detectors;
}

ObstacleList list_of(Detector& detector, PointView cloud) {
  ObstacleList list(static_cast<std::size_t>(MemorySettings().obstacles));
  detector.detect(cloud, list.obstacles);
  return list;
}

FindClusters finder_of(Detector& detector) {
  return [&detector](PointView cloud) {
    FixedVector<Obstacle> unused(1);
    detector.detect(cloud, unused);
    return detector.clustered();
  };
}

std::vector<LabelledClusters> label_worlds(
    std::span<const FindClusters> ways,
    const std::function<CloudWorld(std::uint64_t seed)>& world_of, const SeedRange& seeds,
    const std::string& what) {
  std::vector<LabelledClusters> all(ways.size());
  Progress progress("clusters for " + what, seeds.count);
  for (std::size_t i = 0; i < seeds.count; ++i) {
    const CloudWorld world = world_of(seeds.first + i);
    for (std::size_t w = 0; w < ways.size(); ++w) {
      all[w] += label_clusters(ways[w](world.cloud), world.terrain.features(),
                               world.truth.visible[0].ids);
    }
    progress(i + 1);
  }
  return all;
}

void write_text(const StudyTask& task, const std::string& name, const std::string& text) {
  std::ofstream stream(task.out / name, std::ios::binary);
  stream << text << std::flush;
  if (!stream) throw Failure("cannot write " + (task.out / name).string());
  fmt::print("wrote {}\n", (task.out / name).string());
}

void write_table(const StudyTask& task, const std::string& name, const std::string& text) {
  fmt::print("{}\n", text);
  write_text(task, name, text);
}

void write_picture(const StudyTask& task, const std::string& name, Drawing& drawing) {
  drawing.write_png(task.out / name);
  fmt::print("wrote {}\n", (task.out / name).string());
}

void add_study(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "study", "Repeat an experiment of the paper on simulated terrain: a table and a picture");
  auto options = std::make_shared<StudyOptions>();
  command->footer("Studies:" + listing());
  std::vector<std::string> names;
  names.reserve(kStudies.size());
  for (const Study& study : kStudies) names.emplace_back(study.name);
  command->add_option("NAME", options->name, "see below")->required()->check(one_of(names));
  command->add_option("--out", options->out, "folder for table and picture")->required();
  command->add_option("--config", options->config, "configuration; default: the shipped settings")
      ->check(CLI::ExistingFile);
  command->add_option("--seed", options->seed, "first terrain")
      ->check(CLI::Range(0.0, 1e15))
      ->capture_default_str();
  command->add_option("--seeds", options->seeds, "terrains; default: as listed below")
      ->check(CLI::Range(1, 100'000));
  command->add_option("--training", options->training, "terrains to train on, where a study trains")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  command
      ->add_option("--points", options->points, "of each cloud, where a study does not vary them")
      ->check(CLI::Range(std::size_t{1000}, std::size_t{1} << 20U))
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "of each drive, where a study drives")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  options->outputs.add_to(*command);
  command->callback([options] { run(*options); });
}

}  // namespace scree::cli
