#include "simulator/drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/body.hpp"
#include "simulator/truth.hpp"

namespace scree {
namespace {

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
        draw_track({lead + settings.seconds + 1, settings.speed, settings.reverse, settings.turns},
                   settings.seed);
    world.track_start_ns = kDriveStartNs - static_cast<std::int64_t>(lead * 1e9);
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

Terrain make_terrain(const CaptureSettings& settings) {
  return {draw_world(settings).terrain, settings.seed};
}

Motion make_motion(const CaptureSettings& settings, const Terrain& terrain) {
  if (settings.at_rest) return Motion(Pose());
  const World world = draw_world(settings);
  return follow_ground(world.track, terrain, draw_body(settings.seed), world.track_start_ns,
                       settings.seed);
}

}  // namespace

SimulatedLidarSettings draw_lidar(const CaptureSettings& settings, const LidarSettings& mounted) {
  Random random(settings.seed, 0x11D0);
  SimulatedLidarSettings lidar;
  lidar.model = mounted.model;
  lidar.rate_hz = settings.rate_hz * random.uniform(0.997, 1.003);
  lidar.start_turn = settings.at_rest ? 0 : random.uniform();
  // From what sensors at rest indoors show to nearly the 3 cm of the VLP-16's data sheet.
  lidar.range_noise = random.uniform(0.006, 0.025);
  lidar.laser_bias = random.uniform(0.003, 0.01);
  lidar.lost_share = random.uniform(0.001, 0.01);
  lidar.dust_share = random.chance(0.5) ? 0 : random.uniform(0, 3e-4);
  lidar.is_locked = settings.pps;
  if (!settings.pps) {
    lidar.clock_offset_ns = static_cast<std::int64_t>(random.uniform(0, 3.5e12));
    lidar.clock_skew = random.uniform(-20e-6, 20e-6);
  }
  if (random.chance(0.3)) lidar.dust_puffs = random.uniform(4, 15);
  if (settings.dual) lidar.mode = velodyne::ReturnMode::dual;
  return lidar;
}

SimulatedImuSettings draw_imu(const CaptureSettings& settings) {
  Random random(settings.seed, 0x1A1);
  SimulatedImuSettings imu;
  imu.rate_hz = settings.imu_rate_hz;
  imu.has_orientation = settings.imu_orientation;
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

Drive::Drive(const CaptureSettings& drawn)
    : settings(drawn),
      robot(draw_robot(drawn.seed)),
      terrain(make_terrain(drawn)),
      motion(make_motion(drawn, terrain)),
      movers(draw_movers(drawn.movers, terrain, motion, kDriveStartNs,
                         kDriveStartNs + static_cast<std::int64_t>(drawn.seconds * 1e9),
                         drawn.seed)) {}

void Observer::watch(const SimulatedLidar& lidar) {
  for (auto shots = lidar.shots(); !shots.empty(); shots = shots.subspan(velodyne::kLasers)) {
    const auto firing = shots.first(velodyne::kLasers);
    if (lidar.turns(firing.front().t_ns) >= turns_ + 1) {
      visibility_.end_sweep();
      auto [ids, ignore] = visibility_.asked_for(motion_.base(last_shot_ns_), last_shot_ns_);
      truth_.visible.push_back({last_shot_ns_, std::move(ids), std::move(ignore)});
      ++turns_;
    }
    visibility_.add(firing);
    last_shot_ns_ = firing.back().t_ns;
  }
}

namespace {

constexpr std::int64_t kEncoderStepNs = 10'000'000;

SimulatedEncoder make_encoder(const Drive& drive) {
  return {drive.motion, drive.robot.encoder, draw_encoder(drive.settings), drive.settings.seed};
}

}  // namespace

DriveFeed::DriveFeed(const Drive& drive, const Faults& faults)
    : drive_(drive),
      faults_(faults),
      losses_(drive.settings.seed, 0x1055),
      caster_(drive.terrain),
      lidar_(drive.terrain, caster_, draw_lidar(drive.settings, drive.robot.lidar), drive.motion,
             drive.robot.lidar.mount(), kDriveStartNs, drive.settings.seed, drive.movers),
      imu_(drive.motion, drive.robot.imu_mount(), draw_imu(drive.settings),
           kDriveStartNs - kEncoderStepNs, drive.settings.seed),
      encoder_(make_encoder(drive)),
      observer_(drive, truth_),
      next_sample_(imu_.next()),
      imu_noise_(drive.settings.seed, faults.imu_corruption),
      imu_stream_(drive.robot.imu, [this](const ImuSample& sample) { decoded_.push_back(sample); }),
      encoder_gain_(1 + draw_encoder(drive.settings).scale_error),
      encoder_ns_(kDriveStartNs - kEncoderStepNs) {
  truth_.obstacles = true_obstacles(drive.terrain, drive.movers);
}

bool DriveFeed::next(Sweep& sweep, std::initializer_list<SyncBuffer*> sensors) {
  const double turns = std::round(drive_.settings.seconds * drive_.settings.rate_hz);
  if (turns_ >= turns) return false;
  sweep.clear();
  ++turns_;
  while (true) {
    for (; shot_ < lidar_.shots().size(); ++shot_) {
      const SimulatedShot& shot = lidar_.shots()[shot_];
      // A firing begins before the turn ends as a whole or not at all.
      if (shot_ % velodyne::kLasers == 0 && lidar_.turns(shot.t_ns) >= turns_) {
        sweep.shift(-static_cast<std::int32_t>(last_ns_ - begin_ns_));
        sweep.end_ns = last_ns_;
        begin_ns_ = shot.t_ns;
        feed_imu(sweep.end_ns + 2 * kEncoderStepNs, sensors);
        feed_encoder(sweep.end_ns + 2 * kEncoderStepNs, sensors);
        return true;
      }
      last_ns_ = shot.t_ns;
      if (is_lost_) continue;
      const Eigen::Vector3f at = lidar_.point_of(shot_).cast<float>();
      const auto since_begin_ns = static_cast<std::int32_t>(shot.t_ns - begin_ns_);
      if (shot.range > 0) {
        sweep.push_back(at, shot.reflectivity, since_begin_ns, shot_ % velodyne::kLasers);
      } else {
        sweep.empty.push_back({at, since_begin_ns});
      }
    }
    lidar_.advance();
    observer_.watch(lidar_);
    is_lost_ = losses_.chance(faults_.packet_loss);
    shot_ = 0;
  }
}

void DriveFeed::feed_imu(std::int64_t t_ns, std::initializer_list<SyncBuffer*> sensors) {
  for (; next_sample_.t_ns < t_ns; next_sample_ = imu_.next()) {
    if (faults_.imu_gap.holds(since_start(next_sample_.t_ns))) continue;
    decoded_.clear();
    if (faults_.imu_corruption > 0) {
      imu_bytes_.clear();
      for (const std::uint8_t byte : mt_data2(next_sample_)) imu_noise_.pass(byte, imu_bytes_);
      imu_stream_.take(imu_bytes_, next_sample_.t_ns);
    } else {
      decoded_.push_back(sample_of(next_sample_));
    }
    for (SyncBuffer* each : sensors) {
      for (const ImuSample& sample : decoded_) each->put(sample);
    }
  }
}

void DriveFeed::feed_encoder(std::int64_t t_ns, std::initializer_list<SyncBuffer*> sensors) {
  for (; encoder_ns_ < t_ns; encoder_ns_ += kEncoderStepNs) {
    encoder_.frame(encoder_ns_);
    if (faults_.encoder_gap.holds(since_start(encoder_ns_))) continue;
    EncoderSample sample;
    sample.t_ns = encoder_ns_;
    sample.distance = sample.value = encoder_.turned() * encoder_gain_;
    for (SyncBuffer* each : sensors) each->put(sample);
  }
}

}  // namespace scree
