#include "scree/app/pipeline.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scree/detect/obstacle_box.hpp"
#include "scree/detect/oriented_box.hpp"

namespace scree {

Result<Network> load_network(const std::string& name, const std::filesystem::path& config_file) {
  const auto file = find_file(name, config_file);
  if (!file) return tl::make_unexpected(file.error());
  return Network::load(*file);
}

Result<Network> load_network(const DetectSettings& settings,
                             const std::filesystem::path& config_file) {
  auto network = load_network(settings.network, config_file);
  const std::size_t features = settings.method == Method::edges ? kPaperFeatures : kFeatures;
  if (network && network->inputs() > features) {
    return fail(fmt::format("{} takes {} features, and method = \"{}\" has {}", settings.network,
                            network->inputs(), name_of(settings.method), features));
  }
  return network;
}

Result<Detector> make_detector(const DetectSettings& settings, const DetectorLimits& limits,
                               const std::filesystem::path& config_file) {
  auto network = load_network(settings, config_file);
  if (!network) return tl::make_unexpected(network.error());
  return Detector(settings, limits, *std::move(network));
}

Result<Networks> load_networks(const Settings& settings, const std::filesystem::path& config_file) {
  auto map = load_network(settings.detect_map, config_file);
  if (!map) return tl::make_unexpected(map.error());
  auto sweep = load_network(settings.detect_sweep, config_file);
  if (!sweep) return tl::make_unexpected(sweep.error());
  if (settings.track.network.empty()) return Networks{*map, *sweep, std::nullopt};
  auto judge = load_network(settings.track.network, config_file);
  if (!judge) return tl::make_unexpected(judge.error());
  return Networks{*map, *sweep, *judge};
}

Result<Pipeline> Pipeline::make(const Settings& settings,
                                const std::filesystem::path& config_file) {
  auto networks = load_networks(settings, config_file);
  if (!networks) return tl::make_unexpected(networks.error());
  return Pipeline(settings, *networks);
}

Pipeline::Pipeline(const Settings& settings, const Networks& networks)
    : lidar_(settings.lidar),
      sensors_(std::make_unique<SyncBuffer>()),
      mapper_(std::make_unique<Mapper>(settings)),
      map_detector_(settings.detect_map, settings.memory.for_map(), networks.map),
      sweep_detector_(settings.detect_sweep, settings.memory.for_sweep(), networks.sweep),
      tracker_(settings.track, static_cast<std::size_t>(settings.memory.obstacles), networks.judge),
      sweep_tracker_(TrackingSettings::for_sweep(),
                     static_cast<std::size_t>(settings.memory.obstacles)),
      moving_tracker_(static_cast<std::size_t>(settings.memory.obstacles)),
      polygons_(static_cast<std::size_t>(settings.memory.sweep_points)),
      moving_points_(static_cast<std::size_t>(settings.memory.sweep_points)),
      order_(static_cast<std::size_t>(settings.memory.sweep_points)),
      sweep_(static_cast<std::size_t>(settings.memory.sweep_points)),
      found_(static_cast<std::size_t>(settings.memory.obstacles)),
      list_(static_cast<std::size_t>(settings.memory.obstacles)) {
  if (!settings.lcm.grid || map_detector_.surface_method() == nullptr) return;
  grid_maker_.emplace(
      GridSettings{.cell_size = settings.lcm.grid_cell,
                   .reach = settings.map.search_reach,
                   .body_height = static_cast<float>(settings.detect_map.surface.body_height)});
}

const ObstacleList& Pipeline::process(const Sweep& sweep) {
  timer_.start();
  sensors_->gather();
  if (!uses_map_ && sensors_->has_motion()) {
    uses_map_ = true;
    tracker_.set_next_id(sweep_tracker_.next_id());
  }
  list_.stamp_ns = sweep.end_ns;
  grid_ = nullptr;
  if (uses_map_) {
    mapper_->add(sweep, *sensors_, timer_);
    if (mapper_->was_reset()) {
      tracker_.clear();
      moving_tracker_.clear();
    }
    detect_in_map();
  } else {
    detect_in_sweep(sweep);
  }
  has_looked_ = sweep.is_whole && !ground().empty();
  return list_;
}

void Pipeline::detect_in_map() {
  const RollingMap& map = mapper_->map();
  tracker_.remove_if([&](const Obstacle& obstacle) {
    constexpr double kUpright = 0.8;  // metres: what is lower, beams pass above
    return obstacle.height > kUpright && mapper_->map().remove_left(obstacle);
  });
  SeenCloud cloud = map.seen_cloud();
  cloud.robot = (mapper_->pose().translation - map.origin()).head<2>().cast<float>();
  map_detector_.detect(cloud, found_, timer_);
  const Pose cloud_in_map{map.origin(), Eigen::Quaterniond::Identity()};
  for (Obstacle& obstacle : found_) move_into_parent(cloud_in_map, obstacle);
  tracker_.update(
      list_.stamp_ns, mapper_->pose().translation, {found_.data(), found_.size()},
      [&map](const Eigen::Vector3d& place) { return map.occupancy_at(place); }, list_.obstacles);
  find_moving();
  list_.pose = mapper_->to_odom() * mapper_->pose();
  for (Obstacle& obstacle : list_.obstacles) move_into_parent(mapper_->to_odom(), obstacle);
  timer_.done(Stage::tracking);
  if (!grid_maker_) return;
  grid_ = &grid_maker_->make(map_detector_.surface_method()->ground(),
                             mapper_->to_odom() * cloud_in_map, list_);
  timer_.done(Stage::grid);
}

/// The ground below a place in the map's frame, as the last list had it.
float Pipeline::ground_at(const Eigen::Vector3d& place) const {
  const SurfaceMethod* const method = map_detector_.surface_method();
  const Eigen::Vector3d& origin = mapper_->map().origin();
  const Eigen::Vector3f in_cloud = (place - origin).cast<float>();
  if (method == nullptr || method->ground().columns() == 0) return NAN;
  if (!method->ground().covers(in_cloud.x(), in_cloud.y())) return NAN;
  return method->ground().height(in_cloud.x(), in_cloud.y()) + static_cast<float>(origin.z());
}

Obstacle Pipeline::moving_obstacle(std::span<const std::uint32_t> members) {
  const DeskewedSweep& sweep = mapper_->sweep();
  moving_points_.clear();
  order_.clear();
  float low = 1e9F, high = -1e9F;
  for (const std::uint32_t i : members) {
    const Eigen::Vector3d in_base(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
    const Eigen::Vector3f point = (mapper_->pose() * in_base).cast<float>();
    order_.push_back(static_cast<std::uint32_t>(moving_points_.size()));
    moving_points_.push_back(point.x(), point.y(), point.z(), 0);
    low = std::min(low, point.z());
    high = std::max(high, point.z());
  }
  const OrientedBox box = smallest_box(moving_points_, {order_.data(), order_.size()});
  Obstacle obstacle;
  obstacle.kind = ObstacleKind::positive;
  obstacle.confidence = 1;
  obstacle.center = {box.center_x, box.center_y, low};
  const float ground = ground_at(obstacle.center);
  if (std::isfinite(ground)) low = ground;
  obstacle.center.z() = (low + high) / 2;
  obstacle.height = std::max(high - low, 0.05F);
  obstacle.extent = {box.length, box.width, obstacle.height};
  obstacle.yaw = box.yaw;
  obstacle.points = static_cast<std::uint32_t>(members.size());
  obstacle.footprint = polygons_.around(moving_points_, {order_.data(), order_.size()});
  return obstacle;
}

void Pipeline::find_moving() {
  found_.clear();
  const MovingPoints& moving = mapper_->moving();
  for (std::size_t i = 0; i < moving.size(); ++i) {
    found_.push_back(moving_obstacle(moving.members(i)));
  }
  std::int64_t next_id = tracker_.next_id();
  const RollingMap& map = mapper_->map();
  moving_tracker_.update(
      list_.stamp_ns, {found_.data(), found_.size()},
      [&map](const Eigen::Vector3d& place) { return map.is_seen_through(place); }, next_id);
  tracker_.set_next_id(next_id);
  hand_over_standing();
  for (const MovingTracker::Track& track : moving_tracker_.tracks()) {
    if (track.obstacle.id == 0) continue;
    const Obstacle obstacle = MovingTracker::published(track);
    const auto last =
        std::remove_if(list_.obstacles.begin(), list_.obstacles.end(), [&](const Obstacle& each) {
          return each.velocity.isZero() && distance_to_box(obstacle, each.center) < 0.2;
        });
    list_.obstacles.resize(static_cast<std::size_t>(last - list_.obstacles.begin()));
    list_.obstacles.push_back(obstacle);
  }
}

/// What moved and stands now comes into the map, and keeps its id there.
void Pipeline::hand_over_standing() {
  constexpr double kNear = 0.3;  // metres
  for (Obstacle& obstacle : list_.obstacles) {
    if (obstacle.kind != ObstacleKind::positive) continue;
    for (const MovingTracker::Track& track : moving_tracker_.tracks()) {
      if (track.is_matched || track.obstacle.id == 0) continue;
      if (distance_to_box(track.obstacle, obstacle.center) > kNear) continue;
      const std::int64_t id = track.obstacle.id;
      tracker_.rename(obstacle.id, id);
      obstacle.id = id;
      moving_tracker_.end(id);
      break;
    }
  }
}

void Pipeline::detect_in_sweep(const Sweep& sweep) {
  deskew(sweep, lidar_, still_, sweep_);
  timer_.done(Stage::motion);
  sweep_detector_.detect(
      {.points = sweep_.points, .origins = sweep_.origins, .robot = Eigen::Vector2f::Zero()},
      found_, timer_);
  sweep_tracker_.update(
      list_.stamp_ns, Eigen::Vector3d::Zero(), {found_.data(), found_.size()},
      [](const Eigen::Vector3d&) { return Occupancy::unknown; }, list_.obstacles);
  timer_.done(Stage::tracking);
}

StageCounts Pipeline::counts() const {
  StageCounts counts = detector().counts();
  const std::size_t dropped = uses_map_ ? mapper_->sweep().dropped : sweep_.dropped;
  counts.input += dropped;
  counts.dropped += dropped;
  return counts;
}

}  // namespace scree
