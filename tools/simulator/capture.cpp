#include "simulator/capture.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "scree/capture/pcap_writer.hpp"
#include "scree/capture/pcd.hpp"
#include "simulator/body.hpp"
#include "simulator/imu.hpp"
#include "simulator/links.hpp"
#include "simulator/robot.hpp"
#include "simulator/truth.hpp"
#include "simulator/visibility.hpp"

namespace scree {
namespace {

constexpr std::int64_t kStartNs = 1598612520'000000000;  // 28 August 2020, 11:02 UTC

/// Seconds since the capture's begin.
double since_start(std::int64_t t_ns) {
  return static_cast<double>(t_ns - kStartNs) * 1e-9;
}

/// Tells sweeps apart and notes at the end of each what has been seen.
class Observer {
public:
  Observer(const Terrain& terrain, const Motion& motion, Truth& truth)
      : visibility_(terrain), motion_(motion), truth_(truth) {}

  void watch(const SimulatedLidar& lidar) {
    for (auto shots = lidar.shots(); !shots.empty(); shots = shots.subspan(velodyne::kLasers)) {
      const auto firing = shots.first(velodyne::kLasers);
      if (lidar.turns(firing.front().t_ns) >= turns_ + 1) {
        visibility_.end_sweep();
        auto [ids, ignore] = visibility_.asked_for(motion_.base(last_shot_ns_));
        truth_.visible.push_back({last_shot_ns_, std::move(ids), std::move(ignore)});
        ++turns_;
      }
      visibility_.add(firing);
      last_shot_ns_ = firing.back().t_ns;
    }
  }
  /// Turns finished since the motor's zero.
  double turns() const { return turns_; }

private:
  Visibility visibility_;
  const Motion& motion_;
  Truth& truth_;
  double turns_ = 0;
  std::int64_t last_shot_ns_ = 0;
};

/// The way of a drive, and the country around it.
struct World {
  std::vector<TrackPoint> track;  ///< empty where the robot stands
  std::int64_t track_start_ns = 0;
  TerrainSettings terrain;
};

World draw_world(const CaptureSettings& settings) {
  constexpr double kObstaclesWithin = 10;  // of the way
  World world;
  if (settings.at_rest) {
    const double area = 4 * kObstaclesWithin * kObstaclesWithin;
    world.terrain = scene_terrain(settings.scene, area, settings.seed);
    world.terrain.size = 2 * (kObstaclesWithin + settings.margin);
    world.terrain.placed_within = kObstaclesWithin;
    world.terrain.clear_radius = 1.5;
    world.terrain.level_radius = 0.8;
  } else {
    // Some recordings begin while the robot drives already.
    const double lead = Random(settings.seed, 0x7AC5).uniform(0.3, 3.5);
    world.track =
        draw_track({lead + settings.seconds + 1, settings.speed, settings.reverse}, settings.seed);
    world.track_start_ns = kStartNs - static_cast<std::int64_t>(lead * 1e9);
    const auto way = thinned(world.track);
    const double length = 0.25 * static_cast<double>(way.size());
    double far = 0;
    for (const Eigen::Vector2d& point : way) far = std::max(far, point.cwiseAbs().maxCoeff());
    // A way that winds covers less than a straight one of its length.
    const double reached = 4 * (far + kObstaclesWithin) * (far + kObstaclesWithin);
    const double area = std::min(2 * kObstaclesWithin * (length + kObstaclesWithin), 0.8 * reached);
    world.terrain = scene_terrain(settings.scene, area, settings.seed);
    world.terrain.size = 2 * std::ceil(far + settings.margin);
    world.terrain.placed_within = kObstaclesWithin;
    world.terrain.corridor = way;
    constexpr double kRobotHalfWidth = 0.4;
    world.terrain.corridor_half_width = 0.6 + kRobotHalfWidth;
  }
  world.terrain.cell = settings.cell;
  return world;
}

SimulatedLidarSettings draw_lidar(const CaptureSettings& settings, const LidarSettings& mounted) {
  Random random(settings.seed, 0x11D0);
  SimulatedLidarSettings lidar;
  lidar.model = mounted.model;
  lidar.rate_hz = settings.rate_hz * random.uniform(0.997, 1.003);
  lidar.start_turn = settings.at_rest ? 0 : random.uniform();
  lidar.range_noise = random.uniform(0.006, 0.014);
  lidar.laser_bias = random.uniform(0.003, 0.01);
  lidar.lost_share = random.uniform(0.001, 0.01);
  lidar.dust_share = random.chance(0.5) ? 0 : random.uniform(0, 3e-4);
  lidar.is_locked = settings.pps;
  if (!settings.pps) {
    lidar.clock_offset_ns = static_cast<std::int64_t>(random.uniform(0, 3.5e12));
    lidar.clock_skew = random.uniform(-20e-6, 20e-6);
  }
  if (settings.dual) lidar.mode = velodyne::ReturnMode::dual;
  return lidar;
}

SimulatedImuSettings draw_imu(const CaptureSettings& settings) {
  Random random(settings.seed, 0x1A1);
  SimulatedImuSettings imu;
  imu.rate_hz = settings.imu_rate_hz;
  imu.gyro_bias = random.uniform(0.0003, 0.003);
  imu.gyro_vibration = random.uniform(0.001, 0.015);
  imu.acceleration_vibration = random.uniform(0.05, 0.7);
  imu.tilt_error = radians(random.uniform(0.1, 0.4));
  imu.tilt_correlation = random.uniform(10, 40);
  imu.yaw_drift = radians(random.uniform(0.005, 0.05));
  imu.yaw_offset = random.uniform(-3.1, 3.1);
  imu.clock_skew = random.uniform(-40e-6, 40e-6);
  return imu;
}

SimulatedEncoderSettings draw_encoder(const CaptureSettings& settings) {
  Random random(settings.seed, 0xE4D);
  SimulatedEncoderSettings encoder;
  encoder.scale_error = random.uniform(-0.009, 0.009);
  encoder.slope_slip = random.uniform(0, 0.06);
  encoder.bursts_a_minute = random.chance(0.3) ? 0 : random.uniform(2, 15);
  return encoder;
}

/// What the IMU answers while its driver sets it up.
void greet(SerialPort& port, std::int64_t t_ns) {
  constexpr std::int64_t kPause = 50'000'000;
  using xsens::MessageId;
  t_ns -= 4 * kPause;
  for (const MessageId id :
       {MessageId::wake_up, MessageId::go_to_config_ack, MessageId::go_to_measurement_ack}) {
    port.send(t_ns, xbus_message(id, {}));
    t_ns += kPause;
  }
}

Result<void> write_imu(const std::filesystem::path& file, const CaptureSettings& settings,
                       const Robot& robot, const Motion& motion, std::int64_t end_ns) {
  auto pcap = PcapWriter::create_serial(file);
  if (!pcap) return tl::make_unexpected(pcap.error());
  Random random(settings.seed, 0x1A2);
  const std::int64_t start = kStartNs - static_cast<std::int64_t>(random.uniform(0, 2e8));
  // The filter and the device's queue hold a sample back for a moment.
  const auto held_back = static_cast<std::int64_t>(random.uniform(1e6, 4e6));
  SimulatedImu imu(motion, robot.imu_mount(), draw_imu(settings), start, settings.seed);
  constexpr std::int64_t kBurstNs = 16'000'000;
  SerialPort port(*pcap, robot.imu.baud, settings.imu_bursts ? kBurstNs : 0, settings.seed);
  greet(port, start);
  port.corrupt(settings.faults.imu_corruption);
  for (ImuMessage sample = imu.next(); sample.t_ns < end_ns; sample = imu.next()) {
    if (settings.faults.imu_gap.holds(since_start(sample.t_ns))) continue;
    port.send(sample.t_ns + held_back, mt_data2(sample));
  }
  port.finish();
  return pcap->close();
}

Result<void> write_can(const std::filesystem::path& file, const CaptureSettings& settings,
                       const Robot& robot, const Motion& motion, std::int64_t end_ns) {
  const SimulatedEncoderSettings drawn = draw_encoder(settings);
  SimulatedEncoder encoder(motion, robot.encoder, drawn, settings.seed);
  CanBus bus(file, robot.encoder, settings.seed);
  bus.lose_encoder([gap = settings.faults.encoder_gap](std::int64_t t_ns) {
    return gap.holds(since_start(t_ns));
  });
  bus.start(kStartNs - 50'000'000, drawn.rate_hz);
  bus.run_until(end_ns, encoder);
  if (!bus.close()) return fail(fmt::format("cannot write {}", file.string()));
  return {};
}

/// Writes lidar.pcap and what it has shown. Returns the time of its end.
Result<std::int64_t> write_lidar(const std::filesystem::path& file, const CaptureSettings& settings,
                                 const Robot& robot, const Terrain& terrain, const Motion& motion,
                                 Truth& truth, const std::function<void(std::size_t)>& progress) {
  auto pcap = PcapWriter::create_ethernet(file);
  if (!pcap) return tl::make_unexpected(pcap.error());
  const RayCaster caster(terrain);
  SimulatedLidar lidar(terrain, caster, draw_lidar(settings, robot.lidar), motion,
                       robot.lidar.mount(), kStartNs, settings.seed);
  Network network(*pcap, robot.lidar, settings.faults.packet_loss, settings.seed);
  Observer observer(terrain, motion, truth);
  // The packet that begins the turn after the last one is there too, so that the last sweep ends.
  const double turns = std::max(std::round(settings.seconds * settings.rate_hz), 1.0);
  while (observer.turns() < turns) {
    lidar.advance();
    observer.watch(lidar);
    network.send(lidar);
    const double done = std::min(lidar.turns(lidar.packet_end_ns()) / turns, 1.0);
    progress(static_cast<std::size_t>(1000 * done));
  }
  if (auto closed = pcap->close(); !closed) return tl::make_unexpected(closed.error());
  return lidar.packet_end_ns();
}

}  // namespace

Result<void> write_capture(const std::filesystem::path& folder, const CaptureSettings& settings,
                           const std::function<void(std::size_t)>& progress) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) {
    return fail(fmt::format("cannot make the folder {}: {}", folder.string(), failure.message()));
  }
  const Robot robot = draw_robot(settings.seed);
  if (auto written = write_robot(folder / "scree.toml", robot); !written) return written;
  const World world = draw_world(settings);
  const Terrain terrain(world.terrain, settings.seed);
  const Motion motion =
      settings.at_rest
          ? Motion(Pose())
          : follow_ground(world.track, terrain, draw_body(settings.seed), kStartNs, settings.seed);
  Truth truth;
  const auto end =
      write_lidar(folder / "lidar.pcap", settings, robot, terrain, motion, truth, progress);
  if (!end) return tl::make_unexpected(end.error());
  constexpr std::int64_t kTail = 50'000'000;  // the other sensors outlive the last sweep
  for (const auto write : {write_imu, write_can}) {
    const char* name = write == write_imu ? "imu.pcap" : "can.log";
    if (auto written = write(folder / name, settings, robot, motion, *end + kTail); !written) {
      return written;
    }
  }
  constexpr std::int64_t kPoseStepNs = 10'000'000;
  for (std::int64_t t = kStartNs; t < *end + kPoseStepNs; t += kPoseStepNs) {
    truth.poses.push_back({t, motion.base(t)});
  }
  return write_truth(folder / "truth.json", terrain, truth);
}

Result<void> write_cloud(const std::filesystem::path& file, const CloudSettings& settings,
                         std::uint64_t seed, const TerrainSettings& terrain_settings) {
  const Terrain terrain(terrain_settings, seed);
  const PointCloud cloud = reconstructed_cloud(terrain, settings, seed);
  if (auto written = write_pcd(file, cloud); !written) return written;
  Truth truth;
  truth.poses.push_back({0, Pose()});
  truth.visible.push_back({0, obstacle_ids(terrain), small_ids(terrain)});
  std::filesystem::path beside = file;
  return write_truth(beside.replace_extension(".truth.json"), terrain, truth);
}

}  // namespace scree
