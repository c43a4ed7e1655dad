#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "commands.hpp"
#include "common/outputs.hpp"
#include "detection/detections.hpp"
#include "detection/pipeline_capture.hpp"
#include "draw/top_view.hpp"
#include "live/health_words.hpp"
#include "scree/capture/pcd.hpp"
#include "scree/core/rotation.hpp"

namespace scree::cli {
namespace {

struct PictureOptions {
  std::string input, detections, out, config;
  Outputs outputs;
};

/// What the obstacles lie on.
struct Ground {
  PointCloud points;                                 // `base` frame
  std::string what;                                  // for the subtitle
  std::int64_t stamp_ns = 0;                         // of the sweep
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // of the points in the frame of the lists
};

PointCloud moved(const PointCloud& cloud, const Pose& pose) {
  const Eigen::Affine3f motion =
      (Eigen::Translation3d(pose.translation) * pose.rotation).cast<float>();
  PointCloud result(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f place = motion * Eigen::Vector3f(cloud.x[i], cloud.y[i], cloud.z[i]);
    result.push_back(place.x(), place.y(), place.z(), cloud.reflectivity[i]);
  }
  return result;
}

/// What the detector had at the end of the capture: the map, or, of a lidar alone, the last sweep.
Ground ground_of_capture(const PictureOptions& options) {
  PipelineCapture capture(options.input, options.config);
  Pipeline& pipeline = capture.pipeline();
  Ground ground;
  bool is_whole = false;
  capture.play([&](const Sweep& sweep) {
    // The last sweep may be a part of a turn: of no use by itself.
    if (is_whole && !sweep.is_whole && !pipeline.uses_map()) return;
    pipeline.process(sweep);
    if (!sweep.ends_turn) return;
    is_whole = sweep.is_whole;
    ground.stamp_ns = sweep.end_ns;
  });
  const Mapper& mapper = pipeline.mapper();
  Pose ground_in_base;
  ground.what = "one sweep, ";
  if (pipeline.uses_map()) {
    const Pose map_in_odom{mapper.map().origin(), Eigen::Quaterniond::Identity()};
    ground_in_base = mapper.pose().inverse() * map_in_odom;
    ground.what = "the ground as it was rebuilt until ";
  }
  ground.what += time_of_day(ground.stamp_ns) + " UTC";
  ground.points = moved(pipeline.ground(), ground_in_base);
  return ground;
}

Ground ground_of_cloud(const PictureOptions& options) {
  auto cloud = read_pcd(options.input);
  if (!cloud) throw Failure(cloud.error().message);
  if (cloud->empty()) throw Failure(options.input + ": holds no points");
  const Eigen::Vector3d origin = cloud->origin;
  return {std::move(*cloud), "one point cloud", 0, origin};
}

/// The obstacles of a list in `base`, or in a cloud with this origin.
FixedVector<Obstacle> in_base(const ObstacleList& list, const Eigen::Vector3d& origin) {
  Pose to_base = list.pose.inverse();
  to_base.translation -= origin;
  const double yaw = yaw_of(list.pose.rotation);
  FixedVector<Obstacle> obstacles(list.obstacles.size());
  for (Obstacle obstacle : list.obstacles) {
    move_into_parent(to_base, obstacle);
    obstacle.yaw -= yaw;
    obstacles.push_back(obstacle);
  }
  return obstacles;
}

/// The list of this sweep. A live daemon's lists have other times where a capture was replayed to
/// it: then it is the last one.
const ObstacleList& list_of(const std::vector<ObstacleList>& lists, std::int64_t stamp_ns) {
  constexpr std::int64_t kSameNs = 60'000'000, kMinuteNs = 60'000'000'000;
  const auto apart_ns = [&](const ObstacleList& list) {
    return std::abs(static_cast<double>(list.stamp_ns) - static_cast<double>(stamp_ns));
  };
  const auto nearest = std::ranges::min_element(lists, {}, apart_ns);
  if (apart_ns(*nearest) <= kSameNs) return *nearest;
  if (apart_ns(*nearest) > kMinuteNs) return lists.back();
  throw Failure(fmt::format("no list is of the ground's time: the nearest is {:.1f} s away",
                            apart_ns(*nearest) * 1e-9));
}

void picture(const PictureOptions& options) {
  options.outputs.require_free({options.out}, {options.input, options.detections, options.config});
  require_cairo();
  const auto lists = read_detections(options.detections);
  if (lists.empty()) throw Failure(options.detections + " holds no obstacle list");
  const bool is_cloud = is_pcd(options.input);
  const Ground ground = is_cloud ? ground_of_cloud(options) : ground_of_capture(options);
  const std::string title =
      "Obstacles of " + std::filesystem::path(options.input).lexically_normal().filename().string();
  const ObstacleList& list = list_of(lists, ground.stamp_ns);
  Drawing drawing = draw_top_view(ground.points, in_base(list, ground.origin), title, ground.what);
  drawing.write_png(options.out);
  fmt::print("{}: {}, {} points, {} obstacles\n", options.out, ground.what, ground.points.size(),
             list.obstacles.size());
}

}  // namespace

void add_picture(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "picture",
      "Draw the ground at the end of a capture, or a cloud, with its obstacles from above");
  auto options = std::make_shared<PictureOptions>();
  command->add_option("input", options->input, "capture or .pcd file")
      ->required()
      ->type_name("INPUT");
  command->add_option("detections", options->detections, "its obstacle lists")
      ->required()
      ->type_name("DETECTIONS.jsonl");
  command->add_option("--out", options->out, "picture to write")->required()->type_name("FILE.png");
  command->add_option("--config", options->config, "configuration [scree.toml in the capture]")
      ->type_name("FILE");
  options->outputs.add_to(*command);
  command->callback([options] { picture(*options); });
}

}  // namespace scree::cli
