#include "scree/app/pipeline.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <utility>

#include "scree/motion/sync_buffer_of.hpp"

namespace scree {
namespace {

/// Whether the lidar's own odometry is of use: registration is wanted, and no IMU was heard yet.
bool needs_stand_in(const Mapper& mapper, const SyncBuffer& sensors) {
  return mapper.registers() && sensors.imu().empty();
}

}  // namespace

Result<Network> load_network(const std::string& name, const std::filesystem::path& config_file) {
  const auto file = find_file(name, config_file);
  if (!file) return tl::make_unexpected(file.error());
  return Network::load(*file);
}

/// @param section of the settings, for who reads of a mistake
Result<Network> load_network(const DetectSettings& settings, std::string_view section,
                             const std::filesystem::path& config_file) {
  auto network = load_network(settings.network, config_file);
  const std::size_t features = settings.method == Method::edges ? kPaperFeatures : kFeatures;
  if (network && network->inputs() > features) {
    return fail(fmt::format(
        "{0}.network: {1} takes {2} features, and {0}.method = \"{3}\" has {4}: "
        "name a network that was trained with it",
        section, settings.network, network->inputs(), name_of(settings.method), features));
  }
  return network;
}

Result<Detector> make_detector(const DetectSettings& settings, const DetectorLimits& limits,
                               const std::filesystem::path& config_file) {
  auto network = load_network(settings, "detect.cloud", config_file);
  if (!network) return tl::make_unexpected(network.error());
  return Detector(settings, limits, *std::move(network));
}

Result<Networks> load_networks(const Settings& settings, const std::filesystem::path& config_file) {
  auto map = load_network(settings.detect_map, "detect.map", config_file);
  if (!map) return tl::make_unexpected(map.error());
  auto sweep = load_network(settings.detect_sweep, "detect.sweep", config_file);
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
    : sensors_(sync_buffer_of(settings)),
      mapper_(std::make_unique<Mapper>(settings)),
      setup_(std::make_unique<SetupProbe>(settings)),
      stand_in_(std::make_unique<StandInMotion>(settings)),
      map_detector_(settings.detect_map, settings.memory.for_map(), networks.map),
      sweep_detector_(std::in_place, settings.detect_sweep, settings.memory.for_sweep(),
                      networks.sweep),
      tracker_(settings.track, static_cast<std::size_t>(settings.memory.obstacles), networks.judge),
      sweep_tracker_(TrackingSettings::for_sweep(),
                     static_cast<std::size_t>(settings.memory.obstacles)),
      moving_tracker_(static_cast<std::size_t>(settings.memory.obstacles)),
      moving_boxes_(static_cast<std::size_t>(settings.memory.sweep_points),
                    static_cast<std::size_t>(settings.memory.obstacles)),
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
  grid_ = nullptr;
  turns_ = turns_since_list(sweep);
  list_.stamp_ns = sweep.end_ns;
  if (sweep.ends_turn) {
    process_turn(sweep);
  } else {
    process_part(sweep);
  }
  return list_;
}

void Pipeline::process_turn(const Sweep& sweep) {
  follow_motion(sweep);
  if (motion_ != nullptr) {
    mapper_->add(sweep, *motion_, timer_);
    if (mapper_->was_reset()) clear_tracks();
  } else {
    mapper_->take_still(sweep);
    timer_.done(Stage::motion);
  }
  // A map that has just begun has confirmed nothing yet.
  uses_map_ = motion_ != nullptr && (!sweep_detector_ || !mapper_->map().cloud().empty());
  if (uses_map_) {
    detect_in_map(true);
  } else {
    detect_in_sweep(motion_ != nullptr ? mapper_->pose() : Pose());
  }
  report_setup();
  has_looked_ = sweep.is_whole && !ground().empty() && had_room();
}

/// Whether most of a turn's points found room: without them nothing was looked at.
bool Pipeline::had_room() {
  const DeskewedSweep& sweep = mapper_->sweep();
  const std::uint64_t before = std::exchange(map_dropped_, mapper_->map().dropped());
  const std::uint64_t lost_by_map = map_dropped_ - before;
  return sweep.dropped <= sweep.points.size() && 2 * lost_by_map <= sweep.points.size();
}

void Pipeline::process_part(const Sweep& sweep) {
  has_looked_ = uses_map_ && motion_ == sensors_.get() && sweep.is_whole;
  if (!has_looked_) return list_.obstacles.clear();
  mapper_->add_part(sweep, *motion_, timer_);
  detect_in_map(false);
  has_looked_ = !ground().empty();
}

/// How much of a turn the list is later than the one before.
float Pipeline::turns_since_list(const Sweep& sweep) {
  if (sweep.ends_turn && !sweep.time_ns.empty()) turn_ns_ = -std::int64_t{sweep.time_ns[0]};
  const bool had_part = std::exchange(is_within_turn_, !sweep.ends_turn);
  if ((sweep.ends_turn && !had_part) || turn_ns_ <= 0) return 1;
  const std::int64_t since_ns = sweep.end_ns - list_.stamp_ns;
  return std::clamp(static_cast<float>(since_ns) / static_cast<float>(turn_ns_), 0.0F, 1.0F);
}

/// Decides whose motion the map goes by, and begins it anew where that does not follow.
void Pipeline::follow_motion(const Sweep& sweep) {
  const bool follows = setup_->add(sweep, *sensors_);
  const bool stands_in = needs_stand_in(*mapper_, *sensors_);
  if (stands_in) stand_in_->add(setup_->odometry(), follows, *sensors_);
  timer_.done(Stage::setup);
  const SyncBuffer* const before = std::exchange(motion_, choose_motion());
  if (sensors_->has_motion()) sweep_detector_.reset();  // gives its memory back, once
  const bool goes_on =
      motion_ == before && (follows || sensors_->has_motion()) && !starts_over(sweep, follows);
  if (motion_ != nullptr && has_map_ && !goes_on) {
    if (motion_ != before && before != nullptr && follows) {
      mapper_->change_sensors();
    } else {
      mapper_->restart();
    }
    clear_tracks();
  } else if (stands_in && !sensors_->has_motion() && stand_in_->settles()) {
    mapper_->forget_ground();
    clear_tracks();
  }
  has_map_ = has_map_ || motion_ != nullptr;
}

/// Whether the lidar has started over, and the IMU with it: both were off, or are played again, so
/// that nobody knows how the robot moved meanwhile. Without an IMU the ground tells.
bool Pipeline::starts_over(const Sweep& sweep, bool follows) {
  constexpr std::int64_t kTogetherNs = 2'000'000'000;
  if (sweep.started_over) lidar_restart_ns_ = sweep.end_ns;
  if (lidar_restart_ns_ == 0) return false;
  const auto is_near = [&](std::int64_t t_ns) {
    return std::abs(t_ns - lidar_restart_ns_) < kTogetherNs;
  };
  const bool is_unknown = sensors_->imu().empty() ? !follows : is_near(sensors_->imu_restart_ns());
  if (is_unknown || !is_near(sweep.end_ns)) lidar_restart_ns_ = 0;
  return is_unknown;
}

/// Null where nothing tells how the robot moves.
const SyncBuffer* Pipeline::choose_motion() const {
  const bool stands_in = needs_stand_in(*mapper_, *sensors_);
  if (sensors_->has_motion() && !stands_in) return sensors_.get();
  if (stands_in && (sensors_->has_motion() || stand_in_->is_bound())) return &stand_in_->samples();
  return nullptr;
}

void Pipeline::clear_tracks() {
  tracker_.clear();
  moving_tracker_.clear();
}

void Pipeline::report_setup() {
  setup_report_ = setup_->report();
  if (motion_ == nullptr) setup_report_.add({.fault = SetupFault::motion_unknown});
  for (const BodyBox& box : mapper_->own_returns().found()) {
    setup_report_.add({.fault = SetupFault::robot_body, .set = box.low, .high = box.high});
  }
}

/// @param ends_turn else what moves is not looked for
void Pipeline::detect_in_map(bool ends_turn) {
  const RollingMap& map = mapper_->map();
  const std::size_t left = tracker_.remove_if([this](const Obstacle& obstacle) {
    return mapper_->remove_left(obstacle, moving_tracker_.was_left(obstacle));
  });
  if (left > 0) mapper_->update_cloud();
  SeenCloud cloud = map.seen_cloud();
  cloud.robot = (mapper_->pose().translation - map.origin()).head<2>().cast<float>();
  cloud.reach = map.search_reach();
  map_detector_.detect(cloud, found_, timer_);
  const Pose cloud_in_map{map.origin(), Eigen::Quaterniond::Identity()};
  for (Obstacle& obstacle : found_) move_into_parent(cloud_in_map, obstacle);
  tracker_.update(
      list_.stamp_ns, mapper_->pose().translation, {found_.data(), found_.size()},
      [&map](const Eigen::Vector3d& place) { return map.occupancy_at(place); }, list_.obstacles,
      turns_);
  if (ends_turn) {
    find_moving();
  } else {
    moving_tracker_.predict(list_.stamp_ns);
  }
  moving_tracker_.add_to(list_.obstacles, mapper_->pose().translation, tracker_);
  list_.pose = mapper_->to_odom() * mapper_->pose();
  for (Obstacle& obstacle : list_.obstacles) move_into_parent(mapper_->to_odom(), obstacle);
  timer_.done(Stage::tracking);
  if (!grid_maker_) return;
  grid_ = &grid_maker_->make(map_detector_.surface_method()->ground(),
                             mapper_->to_odom() * cloud_in_map, list_);
  timer_.done(Stage::grid);
}

/// Follows what moves in the sweep.
void Pipeline::find_moving() {
  const RollingMap& map = mapper_->map();
  const MovingPoints& moving = mapper_->moving();
  moving_boxes_.clear();
  for (std::size_t i = 0; i < moving.size(); ++i) {
    moving_boxes_.add(mapper_->sweep().points, moving.members(i), mapper_->pose(),
                      [this](const Eigen::Vector3d& place) { return ground_at(place); });
  }
  std::int64_t next_id = tracker_.next_id();
  moving_tracker_.update(
      list_.stamp_ns, moving_boxes_.found(),
      [&map](const Eigen::Vector3d& place) { return map.is_seen_through(place); }, next_id);
  tracker_.set_next_id(next_id);
}

/// z of the ground at a place in the map's frame; no number where it is not known.
float Pipeline::ground_at(const Eigen::Vector3d& place) const {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  const SurfaceMethod* const method = map_detector_.surface_method();
  if (method == nullptr || method->ground().columns() == 0) return kUnknown;
  const Eigen::Vector3d& origin = mapper_->map().origin();
  const Eigen::Vector3f in_cloud = (place - origin).cast<float>();
  if (!method->ground().covers(in_cloud.x(), in_cloud.y())) return kUnknown;
  return method->ground().height(in_cloud.x(), in_cloud.y()) + static_cast<float>(origin.z());
}

/// @param pose of `base` in `odom`
void Pipeline::detect_in_sweep(const Pose& pose) {
  const DeskewedSweep& still = mapper_->sweep();
  sweep_detector_->detect(
      {.points = still.points, .origins = still.origins, .robot = Eigen::Vector2f::Zero()}, found_,
      timer_);
  sweep_tracker_.set_next_id(tracker_.next_id());
  sweep_tracker_.update(
      list_.stamp_ns, Eigen::Vector3d::Zero(), {found_.data(), found_.size()},
      [](const Eigen::Vector3d&) { return Occupancy::unknown; }, list_.obstacles);
  tracker_.set_next_id(sweep_tracker_.next_id());
  list_.pose = pose;
  for (Obstacle& obstacle : list_.obstacles) move_into_parent(pose, obstacle);
  timer_.done(Stage::tracking);
}

StageCounts Pipeline::counts() const {
  StageCounts counts = detector().counts();
  const std::size_t dropped = mapper_->sweep().dropped;
  counts.input += dropped;
  counts.dropped += dropped;
  return counts;
}

}  // namespace scree
