#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

#include "commands.hpp"
#include "detections.hpp"
#include "health_words.hpp"
#include "lidar_capture.hpp"
#include "scree/app/pipeline.hpp"
#include "scree/capture/capture.hpp"
#include "scree/capture/pcd.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"
#include "top_view.hpp"

namespace scree::cli {
namespace {

struct PictureOptions {
  std::string input, detections, out, config;
};

struct Ground {
  PointCloud points;          // `base` frame
  std::string what;           // for the subtitle
  std::int64_t stamp_ns = 0;  // of the sweep
};

/// The last whole sweep of a capture. The very last may be a part of a turn: the fuller of the last
/// two is whole.
class SweepChoice {
public:
  void take(Sweep& sweep) {
    std::swap(last_, before_last_);
    std::swap(last_, sweep);
  }
  const Sweep& chosen() const {
    return last_.points.size() >= before_last_.points.size() ? last_ : before_last_;
  }

private:
  Sweep last_{velodyne::kSweepCapacity}, before_last_{velodyne::kSweepCapacity};
};

/// A sweep of the capture as the detector gets it.
Ground ground_of_capture(const PictureOptions& options) {
  const Settings settings = capture_settings(options.input, options.config);
  const auto config = settings_file(options.input, options.config);
  auto pipeline = Pipeline::make(settings, config.value_or(""));
  if (!pipeline) throw Failure(pipeline.error().message);
  SweepChoice choice;
  velodyne::LidarStream stream(settings.lidar, [&](Sweep& sweep) { choice.take(sweep); });
  LidarCapture capture(options.input, settings);
  capture.play(stream);
  report_capture(capture, stream);
  pipeline->process(choice.chosen());
  const PointCloud& ground = pipeline->ground();
  Ground copy{PointCloud(ground.size()),
              "one sweep, " + time_of_day(choice.chosen().end_ns) + " UTC", choice.chosen().end_ns};
  for (std::size_t i = 0; i < ground.size(); ++i) {
    copy.points.push_back(ground.x[i], ground.y[i], ground.z[i], ground.reflectivity[i]);
  }
  return copy;
}

Ground ground_of_cloud(const PictureOptions& options) {
  auto cloud = read_pcd(options.input);
  if (!cloud) throw Failure(cloud.error().message);
  return {std::move(*cloud), "one point cloud", 0};
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

/// The list of this sweep; the last one where the lists are a live daemon's, whose times are
/// others.
const ObstacleList& list_of(const std::vector<ObstacleList>& lists, std::int64_t stamp_ns) {
  const auto found = std::ranges::find(lists, stamp_ns, &ObstacleList::stamp_ns);
  return found != lists.end() ? *found : lists.back();
}

void picture(const PictureOptions& options) {
  const auto lists = read_detections(options.detections);
  if (lists.empty()) throw Failure(options.detections + " holds no obstacle list");
  const bool is_cloud = std::filesystem::path(options.input).extension() == ".pcd";
  const Ground ground = is_cloud ? ground_of_cloud(options) : ground_of_capture(options);
  const std::string title =
      "Obstacles of " + std::filesystem::path(options.input).lexically_normal().filename().string();
  Drawing drawing =
      draw_top_view(ground.points, in_base(list_of(lists, ground.stamp_ns)), title, ground.what);
  drawing.write_png(options.out);
}

}  // namespace

void add_picture(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "picture",
      "Draw the last whole sweep of a capture, or a cloud, with its obstacles from above");
  auto options = std::make_shared<PictureOptions>();
  command->add_option("input", options->input, "capture or .pcd file")
      ->required()
      ->type_name("INPUT");
  command->add_option("detections", options->detections, "its obstacle lists")
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
