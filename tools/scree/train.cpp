#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <vector>

#include "commands.hpp"
#include "common/outputs.hpp"
#include "common/progress.hpp"
#include "common/words.hpp"
#include "scree/app/pipeline.hpp"
#include "scree/config/keys.hpp"
#include "scree/learn/metrics.hpp"
#include "scree/learn/training.hpp"
#include "simulator/scene.hpp"
#include "training/data_set.hpp"

namespace scree::cli {
namespace {

/// Seeds of the three parts stand this far apart, so that no terrain is in two of them.
constexpr std::uint64_t kPart = 100'000;

struct TrainOptions {
  Profile profile = Profile::cloud;
  InputForm counts = InputForm::log1p;
  std::string config, out;
  std::uint64_t seed = 1;
  std::size_t training = 60, validation = 20, held_out = 20;
  TrainingSettings learn;
  Outputs outputs;
};

const std::map<std::string, Profile> kProfiles = {{"cloud", Profile::cloud},
                                                  {"map", Profile::map},
                                                  {"sweep", Profile::sweep},
                                                  {"track", Profile::track}};
const std::map<std::string, InputForm> kForms = {{"raw", InputForm::raw},
                                                 {"log1p", InputForm::log1p}};

template <class Value>
std::string name_in(const std::map<std::string, Value>& names, Value value) {
  for (const auto& [name, candidate] : names) {
    if (candidate == value) return name;
  }
  return "?";
}

struct Part {
  std::string name;
  SeedRange seeds;
  LabelledClusters labelled;

  std::size_t count(Label label) const {
    return static_cast<std::size_t>(
        std::ranges::count(labelled.samples, label, [](const Sample& s) { return s.label; }));
  }
};

Part make_part(const std::string& name, std::uint64_t number, std::size_t count,
               const TrainOptions& options, const Settings& settings, const Network& clusters) {
  Part part{name, {options.seed + number * kPart, count}, {}};
  Progress progress((options.profile == Profile::track ? "tracks for " : "clusters for ") + name,
                    count);
  part.labelled =
      make_data_set(options.profile, settings, part.seeds, std::ref(progress), clusters);
  return part;
}

std::string describe(const Part& part) {
  return fmt::format(
      "{:<10} seeds {}-{}: {} samples (positive {}, negative {}, none {}); {} of {} obstacles "
      "have one\n",
      part.name, part.seeds.first, part.seeds.first + part.seeds.count - 1,
      part.labelled.samples.size(), part.count(Label::positive), part.count(Label::negative),
      part.count(Label::none), part.labelled.found, part.labelled.obstacles);
}

std::string table_of(const Scores& scores) {
  std::string table = "kind      precision  recall     F1\n";
  const auto row = [&](std::string_view kind, const Score& score) {
    table += fmt::format("{:<9} {:9.3f} {:7.3f} {:6.3f}\n", kind, score.precision(), score.recall(),
                         score.f1());
  };
  row("positive", scores.positive);
  row("negative", scores.negative);
  row("all", scores.all());
  return table;
}

/// Everything that the weights depend on, and what they reach. No date: the same command gives the
/// same file.
std::string provenance(const TrainOptions& options, const DetectSettings& detect,
                       const std::vector<Part>& parts, const std::vector<TrainingResult>& results,
                       const Scores& scores) {
  const std::string profile = name_in(kProfiles, options.profile);
  std::string text = fmt::format(
      "Network for {}s, trained by Levenberg-Marquardt on simulated terrain.\n"
      "scree train --profile {}{} --seed {} --training {} --validation {} --held-out {} --hidden "
      "{} --inputs {} "
      "--restarts {} --average {} --counts {}\n\n",
      profile, profile, options.config.empty() ? "" : " --config " + options.config, options.seed,
      options.training, options.validation, options.held_out, options.learn.hidden,
      options.learn.inputs, options.learn.restarts, options.learn.averaged,
      name_in(kForms, options.counts));
  for (const Part& part : parts) text += describe(part);
  for (const TrainingResult& result : results) {
    text += fmt::format("{} steps, best {}: {}; mean squared error {:.6f}, validation {:.6f}\n",
                        result.curve.size() - 1, result.best, name_of(result.stop),
                        result.curve[result.best].training_error,
                        result.curve[result.best].validation_error);
  }
  text += "\nSamples of the held-out part:\n" + table_of(scores);
  text += "\nThe detector's settings:\n";
  const std::string table = options.profile == Profile::track ? "map" : profile;
  for_each_detect_key("detect." + table, detect, [&](const Key& key, const auto& value) {
    if (!key.is_live) return;
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_enum_v<Value>) {
      text += fmt::format("{} = \"{}\"\n", key.name, name_of(value));
    } else if constexpr (!std::is_same_v<Value, std::string>) {
      text += fmt::format("{} = {}\n", key.name, value);
    }
  });
  return text;
}

void set_inputs(TrainOptions& options) {
  TrainingSettings& learn = options.learn;
  learn.forms.fill(InputForm::raw);
  if (options.profile == Profile::track) {
    learn.inputs = std::min<std::size_t>(learn.inputs, kTrackFeatures);
    for (const TrackFeature share : {track_positive, track_negative, track_best}) {
      learn.forms[share] = InputForm::logit;
    }
    return;
  }
  if (options.profile == Profile::map) {
    for (const Feature skewed : {mean_height, max_height, min_height, box_length, box_width,
                                 cell_points, cell_spread, roughness, edge_height, range_scatter,
                                 over_loose, least_scatter, all_scatter, ground_scatter}) {
      learn.forms[skewed] = InputForm::root;
    }
  }
  for (const Feature count : {acute_count, obtuse_count, beam_count, solid_core, all_beams}) {
    learn.forms[count] = options.counts;
  }
}

void run(TrainOptions options) {
  options.outputs.require_free({options.out});
  Settings settings;
  settings.lidar = scene_lidar();
  if (!options.config.empty()) {
    const auto loaded = load_settings(options.config);
    if (!loaded) throw Failure(loaded.error().message);
    settings = *loaded;
  }
  const bool is_track = options.profile == Profile::track;
  const DetectSettings& detect = options.profile == Profile::cloud   ? settings.detect_cloud
                                 : options.profile == Profile::sweep ? settings.detect_sweep
                                                                     : settings.detect_map;
  if (options.learn.averaged > options.learn.restarts) {
    throw Failure(fmt::format("--average {} takes more networks than --restarts {} trains",
                              options.learn.averaged, options.learn.restarts));
  }
  if (options.learn.averaged * options.learn.hidden > Network::kMaxHidden) {
    throw Failure(fmt::format("--average {} times --hidden {} is more than {} units",
                              options.learn.averaged, options.learn.hidden, Network::kMaxHidden));
  }
  options.learn.seed = options.seed;
  set_inputs(options);
  Network clusters;
  if (is_track) {
    clusters = value_or_fail(load_network(detect.network, options.config));
  }

  const std::vector<Part> parts = {
      make_part("training", 0, options.training, options, settings, clusters),
      make_part("validation", 1, options.validation, options, settings, clusters),
      make_part("held-out", 2, options.held_out, options, settings, clusters)};
  for (const Part& part : parts) fmt::print("{}", describe(part));
  if (parts[0].labelled.samples.empty()) {
    throw Failure("the detector found no cluster to train on, see its settings");
  }
  const TrainedNetwork trained =
      train_network(parts[0].labelled.samples, parts[1].labelled.samples, options.learn);
  const Scores scores = evaluate(trained.network, parts[2].labelled.samples,
                                 is_track ? settings.track.appear : detect.min_confidence);
  fmt::print("\nsamples of the held-out part:\n{}", table_of(scores));

  require(trained.network.save(options.out,
                               provenance(options, detect, parts, trained.results, scores)));
  fmt::print("\nwrote {}\n", options.out);
}

}  // namespace

void add_train(CLI::App& app) {
  auto* command = app.add_subcommand("train", "trains the network on simulated terrain");
  auto options = std::make_shared<TrainOptions>();
  add_words(*command, "--profile", options->profile, kProfiles, "what the network judges")
      ->default_str("cloud");
  command->add_option("--config", options->config, "the detector's settings, and the lidar's mount")
      ->check(CLI::ExistingFile);
  command->add_option("--out", options->out, "weights file to write")
      ->required()
      ->type_name("FILE");
  command->add_option("--seed", options->seed, "first terrain of the training part")
      ->check(CLI::Range(0.0, 1e15))
      ->capture_default_str();
  const auto terrains = CLI::Range(std::size_t{1}, std::size_t{kPart});
  command->add_option("--training", options->training, "terrains to train on")
      ->check(terrains)
      ->capture_default_str();
  command->add_option("--validation", options->validation, "terrains that end the training")
      ->check(terrains)
      ->capture_default_str();
  command->add_option("--held-out", options->held_out, "terrains that judge the result")
      ->check(terrains)
      ->capture_default_str();
  command->add_option("--hidden", options->learn.hidden, "units of the hidden layer")
      ->check(CLI::Range(std::size_t{1}, Network::kMaxHidden))
      ->capture_default_str();
  command
      ->add_option(
          "--inputs", options->learn.inputs,
          fmt::format("how many of the features; the paper's are the first {}", kPaperFeatures))
      ->check(CLI::Range(std::size_t{1}, std::size_t{kFeatures}))
      ->capture_default_str();
  command->add_option("--restarts", options->learn.restarts, "starts from other weights")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--average", options->learn.averaged,
                   "the best of the restarts whose mean is the network")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_words(*command, "--counts", options->counts, kForms, "how counts of points and beams enter")
      ->default_str("log1p");
  options->outputs.add_to(*command);
  command->callback([options] { run(*options); });
}

}  // namespace scree::cli
