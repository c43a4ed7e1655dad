#include <spdlog/fmt/fmt.h>

#include <memory>

#include "commands.hpp"
#include "detections.hpp"
#include "scree/app/pipeline.hpp"
#include "scree/capture/capture.hpp"
#include "scree/capture/pcap_reader.hpp"
#include "scree/capture/pcd.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"
#include "top_view.hpp"

namespace scree::cli {
namespace {

struct Options {
  std::string input, detections, out, config;
};

struct Ground {
  PointCloud points;  // `base` frame
  std::string what;   // "the last of 20 sweeps"
};

/// The last complete sweep of a capture, as the detector gets it.
Ground ground_of_capture(const Options& options) {
  const auto file = lidar_file(options.input);
  if (!file) throw Failure(file.error().message);
  Settings settings;
  std::filesystem::path config_folder;
  if (const auto config = settings_file(options.input, options.config)) {
    auto loaded = load_settings(*config);
    if (!loaded) throw Failure(loaded.error().message);
    settings = std::move(*loaded);
    config_folder = config->parent_path();
  }
  auto reader = PcapReader::open(*file);
  if (!reader) throw Failure(reader.error().message);

  return {};
}

Ground ground_of_cloud(const Options& options) {
  auto cloud = read_pcd(options.input);
  if (!cloud) throw Failure(cloud.error().message);
  return {std::move(*cloud), "point cloud"};
}

/// The obstacles of a list in `base`.
FixedVector<Obstacle> in_base(const ObstacleList& list) {
  const Eigen::Quaterniond to_base = list.pose.rotation.conjugate();
  const Eigen::Vector3d ahead = list.pose.rotation * Eigen::Vector3d::UnitX();
  FixedVector<Obstacle> obstacles(list.obstacles.size());
  for (Obstacle obstacle : list.obstacles) {
    obstacle.center = to_base * (obstacle.center - list.pose.translation);
    obstacle.yaw -= std::atan2(ahead.y(), ahead.x());
    obstacles.push_back(obstacle);
  }
  return obstacles;
}

void picture(const Options& options) {
  const auto lists = read_detections(options.detections);
  if (lists.empty()) throw Failure(options.detections + " holds no obstacle list");
  const bool is_cloud = std::filesystem::path(options.input).extension() == ".pcd";
  const Ground ground = is_cloud ? ground_of_cloud(options) : ground_of_capture(options);
  const std::string title =
      "Obstacles of " + std::filesystem::path(options.input).lexically_normal().filename().string();
  Drawing drawing = draw_top_view(ground.points, in_base(lists.back()), title, ground.what);
  drawing.write_png(options.out);
}

}  // namespace

void add_picture(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "picture", "Draw the last sweep of a capture, or a cloud, with its obstacles from above");
  auto options = std::make_shared<Options>();
  command->add_option("input", options->input, "capture or .pcd file")
      ->required()
      ->type_name("INPUT");
  command->add_option("detections", options->detections, "its obstacle lists; the last is drawn")
      ->required()
      ->type_name("DETECTIONS.jsonl");
  command->add_option("--out", options->out, "picture to write")->required()->type_name("FILE.png");
  command
      ->add_option("--config", options->config,
                   "configuration with the sensor's mount [scree.toml in the capture]")
      ->type_name("FILE");
  command->callback([options] { picture(*options); });
}

}  // namespace scree::cli
