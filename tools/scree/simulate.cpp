#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "common/outputs.hpp"
#include "common/progress.hpp"
#include "common/usage_error.hpp"
#include "simulator/capture.hpp"
#include "simulator/scene.hpp"

namespace scree::cli {
namespace {

struct SimulateOptions {
  std::string folder, cloud, scene;
  CaptureSettings capture;
  CloudSettings points;
  bool has_faults = false;
  Outputs outputs;
};

/// What was asked for, and with --faults the rest of what can go wrong.
Faults faults_of(const CLI::App& command, const CaptureSettings& capture) {
  if (capture.seconds < kLeastFaultySeconds) {
    throw CLI::ValidationError("--faults",
                               fmt::format("needs --seconds of {:g} or more", kLeastFaultySeconds));
  }
  Faults faults = draw_faults(capture.seconds, capture.seed);
  const auto asked = [&](const char* option) { return command.count(option) > 0; };
  if (asked("--packet-loss")) faults.packet_loss = capture.faults.packet_loss;
  if (asked("--imu-corruption")) faults.imu_corruption = capture.faults.imu_corruption;
  if (asked("--imu-gap")) faults.imu_gap = capture.faults.imu_gap;
  if (asked("--encoder-gap")) faults.encoder_gap = capture.faults.encoder_gap;
  return faults;
}

void add_gap(CLI::App& command, const char* name, const char* help, CLI::Option* cloud, Gap& gap) {
  command
      .add_option_function<std::pair<double, double>>(
          name,
          [&gap](const std::pair<double, double>& asked) {
            gap = {asked.first, asked.second};
          },
          help)
      ->type_name("START,SECONDS")
      ->delimiter(',')
      ->excludes(cloud)
      ->check(CLI::Range(0.0, 3600.0));
}

std::vector<std::string> all_scenes() {
  std::vector<std::string> names;
  names.reserve(kScenes.size());
  for (const Scene scene : kScenes) names.emplace_back(name_of(scene));
  return names;
}

void require_free(const SimulateOptions& options) {
  if (!options.cloud.empty()) {
    auto truth = std::filesystem::path(options.cloud).replace_extension(".truth.json");
    return options.outputs.require_free({options.cloud, truth});
  }
  const std::filesystem::path folder = options.folder;
  if (!std::filesystem::exists(folder)) return;
  options.outputs.require_free({folder / "lidar.pcap", folder / "imu.pcap", folder / "can.log",
                                folder / "scree.toml", folder / "truth.json"});
}

void run(const CLI::App& command, const SimulateOptions& options) {
  if (options.folder.empty() == options.cloud.empty()) {
    throw CLI::ValidationError("give either the folder of a capture or --cloud FILE.pcd");
  }
  require_free(options);
  Result<void> written;
  const auto scene = scene_named(options.scene);
  if (options.cloud.empty()) {
    Progress progress("casting", 1000);
    CaptureSettings settings = options.capture;
    settings.scene = scene.value_or(settings.scene);
    if (options.has_faults) settings.faults = faults_of(command, settings);
    written = write_capture(options.folder, settings, std::ref(progress));
  } else {
    const std::uint64_t seed = options.capture.seed;
    written = write_cloud(options.cloud, options.points, seed,
                          scene ? cloud_terrain(*scene, seed) : TerrainSettings());
  }
  require(written);
}

void add_faults(CLI::App& command, SimulateOptions& options, CLI::Option* cloud) {
  Faults& faults = options.capture.faults;
  const auto add_share = [&](const char* name, double& share, const char* help) {
    command.add_option(name, share, help)
        ->excludes(cloud)
        ->check(CLI::Range(0.0, 0.5))
        ->capture_default_str();
  };
  add_share("--packet-loss", faults.packet_loss, "share of the lidar's packets lost");
  add_share("--imu-corruption", faults.imu_corruption,
            "share of the IMU's bytes flipped, dropped or inserted");
  add_gap(command, "--imu-gap", "the IMU's messages get lost", cloud, faults.imu_gap);
  add_gap(command, "--encoder-gap", "the encoder's frames get lost", cloud, faults.encoder_gap);
  command
      .add_flag("--faults", options.has_faults,
                "1 % of packets lost, 1 % of IMU messages corrupted, an IMU gap of 2 s and an "
                "encoder gap of 3 s at times of the seed")
      ->excludes(cloud);
}

void add_drive(CLI::App& command, CaptureSettings& capture, CLI::Option* cloud) {
  command.add_option("--seconds", capture.seconds, "length of the capture")
      ->excludes(cloud)
      ->check(CLI::Range(0.05, 3600.0))
      ->capture_default_str();
  auto* at_rest =
      command.add_flag("--at-rest", capture.at_rest, "the robot stands")->excludes(cloud);
  command
      .add_option("--speed", capture.speed,
                  "mean speed while driving, m/s; without it drawn from 0.4 to 1.6")
      ->excludes(cloud)
      ->excludes(at_rest)
      ->check(CLI::Range(0.3, 2.0));
  command.add_option("--rate", capture.rate_hz, "turns of the lidar a second")
      ->excludes(cloud)
      ->check(CLI::Range(5.0, 20.0))
      ->capture_default_str();
  command.add_flag("--dual", capture.dual, "dual returns")->excludes(cloud);
  command.add_flag("--pps", capture.pps, "the lidar's clock is locked to GPS")->excludes(cloud);
  command
      .add_flag("!--no-orientation", capture.imu_orientation,
                "the IMU sends rates and accelerations alone, as an MTi-1 or MTi-100")
      ->excludes(cloud);
  command.add_flag("--reverse", capture.reverse, "drives backwards for a stretch")
      ->excludes(cloud)
      ->excludes(at_rest);
  command.add_flag("--turns", capture.turns, "stops for a while and turns on the spot")
      ->excludes(cloud)
      ->excludes(at_rest);
}

void add_movers(CLI::App& command, MoverCounts& movers, CLI::Option* cloud) {
  const auto add = [&](const char* name, int& count, const char* help) {
    command.add_option(name, count, help)
        ->excludes(cloud)
        ->check(CLI::Range(0, 50))
        ->capture_default_str();
  };
  add("--people", movers.people, "who walk or run near the robot; those without a way stay away");
  add("--animals", movers.animals, "likewise");
  add("--vehicles", movers.vehicles, "likewise");
}

void add_imu(CLI::App& command, CaptureSettings& capture, CLI::Option* cloud) {
  command.add_option("--imu-rate", capture.imu_rate_hz, "samples of the IMU a second")
      ->excludes(cloud)
      ->check(CLI::Range(100.0, 400.0))
      ->capture_default_str();
  command
      .add_flag("--imu-bursts", capture.imu_bursts,
                "a USB adapter hands the IMU's bytes on every 16 ms only")
      ->excludes(cloud);
}

}  // namespace

void add_simulate(CLI::App& app) {
  auto* command = app.add_subcommand("simulate", "writes a synthetic capture with its truth");
  auto options = std::make_shared<SimulateOptions>();
  auto* folder = command->add_option("DIR", options->folder, "folder of the capture");
  auto* cloud = command->add_option("--cloud", options->cloud,
                                    "write one reconstructed cloud instead, and FILE.truth.json");
  cloud->excludes(folder);
  command->add_option("--seed", options->capture.seed, "of terrain and noise")
      ->check(CLI::Range(0.0, 1e15))
      ->capture_default_str();
  command->add_option("--scene", options->scene, "kind of ground [easy; a cloud: like the paper's]")
      ->check(one_of(all_scenes()));
  add_drive(*command, options->capture, cloud);
  add_movers(*command, options->capture.movers, cloud);
  add_imu(*command, options->capture, cloud);
  add_faults(*command, *options, cloud);
  command->add_option("--points", options->points.points, "of the cloud")
      ->needs(cloud)
      ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}))
      ->capture_default_str();
  options->outputs.add_to(*command);
  command->callback([command, options] { run(*command, *options); });
}

}  // namespace scree::cli
