#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "common/progress.hpp"
#include "common/temporary_folder.hpp"
#include "detection/pipeline_capture.hpp"
#include "scree/detect/quantile.hpp"
#include "simulator/capture.hpp"
#include "simulator/scene.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

struct BenchOptions {
  fs::path capture, config;
  double seconds = 12;
};

/// What this thread has used of a processor, nanoseconds: other programs do not count.
std::int64_t used_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return time.tv_sec * 1'000'000'000LL + time.tv_nsec;
}

/// What the lists of a drive cost.
struct DriveCost {
  std::size_t lists = 0, voxels = 0;  ///< most of the map
  double median_ms = 0, p99_ms = 0;   ///< of a processor, a list
  double share = 0;                   ///< of a core, decoding and reading the capture included
  std::array<double, kStageNames.size()> stage_ms{};  ///< mean
};

/// Plays a drive as fast as it goes.
DriveCost measure(const fs::path& capture, const fs::path& config) {
  constexpr std::int64_t kFillNs = 3'000'000'000;  // what the map takes to fill
  PipelineCapture played(capture, config);
  Pipeline& pipeline = played.pipeline();
  pipeline.time_stages(used_ns);
  DriveCost cost;
  std::vector<float> costs;
  std::int64_t first_ns = 0, begin_ns = 0, end_ns = 0, used_at_begin = 0, used_at_end = 0;
  played.play([&](const Sweep& sweep) {
    if (first_ns == 0) first_ns = sweep.end_ns;
    const std::int64_t before = used_ns();
    pipeline.process(sweep);
    cost.voxels = std::max(cost.voxels, pipeline.mapper().map().voxels());
    used_at_end = used_ns();
    end_ns = sweep.end_ns;
    if (end_ns - first_ns < kFillNs) return;
    if (begin_ns == 0) {
      begin_ns = end_ns;
      used_at_begin = used_at_end;
      return;
    }
    costs.push_back(static_cast<float>(used_at_end - before) * 1e-6F);
    for (std::size_t i = 0; i < cost.stage_ms.size(); ++i) {
      const std::int64_t ns = pipeline.stage_times()[i];
      if (ns != kDidNotRun) cost.stage_ms[i] += static_cast<double>(ns) * 1e-6;
    }
  });
  cost.lists = costs.size();
  if (costs.empty()) throw Failure("the drive is shorter than the map takes to fill, 3 s");
  for (double& ms : cost.stage_ms) ms /= static_cast<double>(cost.lists);
  cost.median_ms = static_cast<double>(quantile(costs, 0.5));
  cost.p99_ms = static_cast<double>(quantile(costs, 0.99));
  cost.share =
      static_cast<double>(used_at_end - used_at_begin) / static_cast<double>(end_ns - begin_ns);
  return cost;
}

void print(const std::string& name, const DriveCost& cost) {
  fmt::print("{:<8}{:7.0f} % of a core, a list {:5.1f} ms (median), {:5.1f} ms (p99), {} voxels\n",
             name, 100 * cost.share, cost.median_ms, cost.p99_ms, cost.voxels);
  std::fflush(stdout);
}

void print_stages(const DriveCost& cost) {
  fmt::print("\nstage          ms a list\n");
  for (std::size_t i = 0; i < kStageNames.size(); ++i) {
    if (cost.stage_ms[i] > 0) fmt::print("{:<14}{:10.2f}\n", kStageNames[i], cost.stage_ms[i]);
  }
}

/// Whether the detector keeps up when it has a core for itself. What else the robot computes and
/// what the sensors' threads need must find room beside it.
void print_verdict(double share) {
  constexpr double kComfortable = 0.7, kFull = 1;
  if (share < kComfortable) {
    fmt::print("\nThis computer suffices.\n");
  } else if (share < kFull) {
    fmt::print("\nThis computer just suffices, with a core for Scree alone.\n");
  } else {
    fmt::print(
        "\nThis computer is too slow: sweeps are left out. Turn the lidar slower, or make "
        "map.voxel and detect.map.ground_cell larger and map.search_reach shorter.\n");
  }
}

/// Simulates a drive with the lidar turning at this rate, and measures it.
DriveCost measure_simulated(double rate_hz, double seconds) {
  const TemporaryFolder capture("scree-bench");
  CaptureSettings settings;
  settings.scene = Scene::mixed;
  settings.seconds = seconds;
  settings.rate_hz = rate_hz;
  Progress progress("simulating", 1000);
  require(write_capture(capture.path(), settings, std::ref(progress)));
  return measure(capture.path(), {});
}

void run(const BenchOptions& options) {
  if (!options.capture.empty()) {
    const DriveCost cost = measure(options.capture, options.config);
    print(options.capture.filename().string(), cost);
    print_stages(cost);
    return print_verdict(cost.share);
  }
  DriveCost usual;
  for (const double rate_hz : {5.0, 10.0, 20.0}) {
    const DriveCost cost = measure_simulated(rate_hz, options.seconds);
    print(fmt::format("{:.0f} Hz", rate_hz), cost);
    if (rate_hz == 10) usual = cost;
  }
  print_stages(usual);
  print_verdict(usual.share);
}

}  // namespace

void add_bench(CLI::App& app) {
  auto* command =
      app.add_subcommand("bench",
                         "measures what the lists cost on this computer, and whether it "
                         "suffices");
  auto options = std::make_shared<BenchOptions>();
  auto* capture =
      command->add_option("CAPTURE", options->capture, "a drive of yours; default: simulated ones")
          ->check(CLI::ExistingPath);
  command->add_option("--config", options->config, "configuration; default: the capture's own")
      ->needs(capture);
  command->add_option("--seconds", options->seconds, "length of each simulated drive")
      ->excludes(capture)
      ->check(CLI::Range(5.0, 600.0))
      ->capture_default_str();
  command->callback([options] { run(*options); });
}

}  // namespace scree::cli
