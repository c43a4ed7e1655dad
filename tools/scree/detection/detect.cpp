#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "common/fresh_file.hpp"
#include "common/outputs.hpp"
#include "detection/pipeline_capture.hpp"
#include "detection/stages.hpp"
#include "read/lidar_capture.hpp"
#include "scree/app/memory_cap.hpp"
#include "scree/capture/capture.hpp"
#include "scree/capture/pcd.hpp"
#include "scree/detect/viewpoint.hpp"
#include "scree/publish/jsonl.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

struct DetectOptions {
  fs::path input, config, out, grid, stages;
  Outputs outputs;
  std::vector<double> viewpoint;  // x, y, z in metres; empty: the file's
};

/// Lists or grids as lines of JSON, in a file or on standard output.
class LineWriter {
public:
  explicit LineWriter(const fs::path& file) : fresh_(file), to_stdout_(file.empty()) {
    if (to_stdout_) return;
    file_.open(fresh_.path(), std::ios::binary);
    if (!file_) throw Failure("cannot write " + file.string());
  }

  template <class What>
  void write(const What& what) {
    line_.clear();
    append_json_line(what, line_);
    if (to_stdout_) {
      std::fwrite(line_.data(), 1, line_.size(), stdout);
    } else {
      file_ << line_;
    }
  }

  void finish() {
    if (to_stdout_) return;
    file_.close();
    if (!file_) throw Failure("cannot write what was found: the disk may be full");
    fresh_.take_place();
  }

  /// Where counts go, so that they do not mix with lists.
  std::FILE* other_output() const { return to_stdout_ ? stderr : stdout; }

private:
  FreshFile fresh_;
  bool to_stdout_;
  std::ofstream file_;
  std::string line_;
};

void warn_of_losses(const StageCounts& counts, std::string_view what) {
  warn(what, counts.dropped, "points found no room: raise [memory]");
  warn(what, counts.refused, "points are not finite or too far out, and were left out");
  warn(what, counts.candidates_dropped, "points of obstacles found no room: raise [memory]");
  warn(what, counts.obstacles_dropped, "obstacles found no room: raise memory.obstacles");
}

/// The stated one, else the file's, in the frame of the points.
Eigen::Vector3f viewpoint_of(const DetectOptions& options, const PcdCloud& cloud) {
  if (options.viewpoint.empty()) return cloud.viewpoint;
  const Eigen::Map<const Eigen::Vector3d> stated(options.viewpoint.data());
  return (stated - cloud.origin).cast<float>();
}

std::string usable(const StageCounts& counts) {
  const std::size_t usable = counts.input - counts.refused;
  return usable == 0 ? "none" : std::to_string(usable);
}

/// An empty list says "looked, and nothing there".
void require_points(const StageCounts& counts, const fs::path& file) {
  constexpr double kNearlyAll = 0.95;  // of the points: a depth camera's may be mostly no numbers
  constexpr std::size_t kFewest = 30;  // places: fewer are no ground that could be looked at
  const bool has_few =
      static_cast<double>(counts.refused) > kNearlyAll * static_cast<double>(counts.input);
  if (counts.voxels >= kFewest && !has_few) return;
  if (counts.voxels > 0 && !has_few) {
    throw Failure(fmt::format("{}: its points are at {} place{}, too few for a ground to look at",
                              file.string(), counts.voxels, counts.voxels == 1 ? "" : "s"));
  }
  throw Failure(counts.input == 0
                    ? fmt::format("{}: holds no points", file.string())
                    : fmt::format("{}: {} of its {} points can be used: the others are not finite "
                                  "or too far apart; are they in metres?",
                                  file.string(), usable(counts), counts.input));
}

void detect_in_cloud(const DetectOptions& options) {
  if (!options.grid.empty()) throw Failure("--grid is for captures: only the map has a grid");
  Settings settings = capture_settings(options.input, options.config);
  const auto cloud = read_pcd(options.input);
  if (!cloud) throw Failure(cloud.error().message);
  // At the desk there is time: nothing of the file is left out.
  MemorySettings& memory = settings.memory;
  constexpr int kPointsAnObstacle = 64;  // on average: fewer than any field of stones has
  memory.cloud_points = std::max(memory.cloud_points, static_cast<int>(cloud->size()));
  memory.obstacles = std::max(memory.obstacles, memory.cloud_points / kPointsAnObstacle);
  const fs::path file = settings_file(options.input, options.config).value_or(fs::path());
  auto detector =
      within_memory([&] { return make_detector(settings.detect_cloud, memory.for_cloud(), file); });
  if (!detector) throw Failure(detector.error().message);

  ObstacleList list(static_cast<std::size_t>(memory.obstacles));
  const Eigen::Vector3f viewpoint = viewpoint_of(options, *cloud);
  const bool is_known = !options.viewpoint.empty() || could_be_seen_from(viewpoint, *cloud);
  SeenCloud seen{.points = *cloud};
  if (is_known) {
    seen.origins = {&viewpoint, 1};
    seen.robot = viewpoint.head<2>();
  }
  StageTimer none;
  detector->detect(seen, list.obstacles, none);
  require_points(detector->counts(), options.input);
  const Pose cloud_in_file{cloud->origin, Eigen::Quaterniond::Identity()};
  for (Obstacle& obstacle : list.obstacles) move_into_parent(cloud_in_file, obstacle);
  LineWriter writer(options.out);
  writer.write(list);
  writer.finish();
  warn_of_losses(detector->counts(), options.input.string());
  if (options.stages.empty()) return;
  if (!cloud->origin.isZero()) {
    fmt::print(stderr,
               "scree: the stages' points are without the {:.0f} {:.0f} {:.0f} m of the file\n",
               cloud->origin.x(), cloud->origin.y(), cloud->origin.z());
  }
  write_stages(*detector, *cloud, options.stages);
  fmt::print(writer.other_output(), "{}\n", chain(detector->counts()));
}

void detect_in_capture(const DetectOptions& options) {
  PipelineCapture capture(options.input, options.config);
  Pipeline& pipeline = capture.pipeline();
  LineWriter writer(options.out);
  std::optional<LineWriter> grids;
  if (!options.grid.empty()) grids.emplace(options.grid == "-" ? fs::path() : options.grid);
  if (!options.stages.empty()) Outputs::remove_sweeps(options.stages);
  std::size_t sweeps = 0;
  bool has_grid = false, has_turn = false;
  capture.play([&](const Sweep& sweep) {
    const ObstacleList& list = pipeline.process(sweep);
    if (!sweep.ends_turn && !pipeline.has_looked()) return;
    has_turn = has_turn || sweep.is_whole;
    writer.write(list);
    if (grids && pipeline.grid() != nullptr) {
      grids->write(*pipeline.grid());
      has_grid = true;
    }
    const std::string name = fmt::format("sweep_{:06}", sweeps++);
    const StageCounts counts = pipeline.counts();
    warn_of_losses(counts, name);
    if (options.stages.empty()) return;
    write_stages(pipeline.detector(), pipeline.ground(), options.stages / name);
    fmt::print(writer.other_output(), "{}: {}\n", name, chain(counts));
  });
  if (!has_turn) {
    throw Failure(options.input.string() + ": nothing was looked at, the lidar " +
                  (sweeps > 0 ? "makes no whole turn in it"
                   : capture.lidar().counters().standing > 0
                       ? "does not turn"
                       : "has not had a single return (is it covered?)"));
  }
  writer.finish();
  if (!grids) return;
  grids->finish();
  if (has_grid) return;
  throw Failure("there was no grid: it needs lcm.grid, method = \"surface\" and IMU or encoder");
}

}  // namespace

void add_detect(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("detect", "Obstacles in a capture or a point cloud, one line a list");
  auto options = std::make_shared<DetectOptions>();
  command
      ->add_option("INPUT", options->input,
                   "capture (folder, .pcap, .pcapng, LCM log) or cloud (.pcd)")
      ->required()
      ->check(CLI::ExistingPath);
  command->add_option("--config", options->config, "configuration; default: the capture's own");
  command->add_option("--out", options->out, "JSON lines file; default: standard output");
  command->add_option("--grid", options->grid,
                      "JSON lines file: what is free, occupied, a drop or unknown, for each list "
                      "from the map");
  command->add_option("--stages", options->stages,
                      "folder for the cloud of each stage as PCD; prints their counts");
  command
      ->add_option(
          "--viewpoint", options->viewpoint,
          "where a cloud was seen from, X Y Z in metres; default: the file's, where it can "
          "have been seen from there")
      ->expected(3);
  options->outputs.add_to(*command);
  command->callback([options] {
    if (options->out == "-") options->out.clear();
    const bool prints_grid = options->grid == "-";
    if (prints_grid && options->out.empty()) {
      throw CLI::ValidationError("--grid", "standard output has the lists: name a file for one");
    }
    options->outputs.require_free({options->out, prints_grid ? fs::path() : options->grid},
                                  {options->input, options->config});
    const bool is_cloud = is_pcd(options->input) || options->input.extension() == ".pcd";
    if (!options->viewpoint.empty() && !is_cloud) {
      throw CLI::ValidationError("--viewpoint", "is for a cloud");
    }
    options->outputs.require_empty(options->stages);
    if (is_cloud) {
      detect_in_cloud(*options);
    } else {
      detect_in_capture(*options);
    }
  });
}

}  // namespace scree::cli
