#include "scree/terrain/mapper.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "scree/core/rotation.hpp"

namespace scree {
namespace {

constexpr float kSurfel = 0.3F;                 // edge, metres
constexpr double kMaxHeightError = 0.08;        // metres that a point may be too high or too low
constexpr double kInitialAttitudeError = 0.01;  // rad, when the IMU falls silent

/// A power of two.
int cells_across(double metres) {
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(metres / kSurfel))));
}

}  // namespace

Mapper::Mapper(const Settings& settings)
    : lidar_(settings.lidar),
      registers_(settings.map.registration),
      surfel_reach_(settings.map.registration_reach),
      search_reach_(settings.map.search_reach),
      dead_reckoning_(settings.imu.mount().rotation, settings.encoder.translation),
      slip_detector_(settings.imu.mount().rotation, settings.imu.translation,
                     settings.encoder.max_speed, settings.encoder.translation),
      own_returns_(settings.robot.body, settings.lidar.mount()),
      sweep_(static_cast<std::size_t>(settings.memory.sweep_points)),
      levelling_(settings.imu.translation),
      registration_(static_cast<std::size_t>(settings.memory.sweep_points)),
      surfels_(kSurfel, cells_across(2 * settings.map.registration_reach)),
      moving_(static_cast<std::size_t>(settings.memory.sweep_points)),
      map_(settings.map, static_cast<std::size_t>(settings.memory.map_voxels)) {}

void Mapper::add(const Sweep& sweep, const SyncBuffer& sensors, StageTimer& timer) {
  part_pose_.reset();
  const Pose before = filter_.pose();
  detect_slip(sensors, sweep.end_ns);
  step_ = dead_reckoning_.advance(sensors, begin_of(sweep), sweep.end_ns, trajectory_,
                                  !slip_detector_.slips());
  const bool has_known_attitude = filter_.has_known_attitude();
  const bool was_silent = has_known_attitude && !filter_.knows_attitude();
  filter_.predict(step_);
  deskew(sweep, lidar_, trajectory_, own_returns_, sweep_, taken_);
  taken_ = {};
  const bool was_tilted = filter_.has_known_attitude() && !has_known_attitude;
  const bool has_trail = notice_own_returns();
  was_reset_ = was_tilted || has_trail;
  if (was_reset_) forget_ground();
  timer.done(Stage::motion);
  const Eigen::Quaterniond predicted = pose().rotation;
  outcome_ = {};
  if (registers_) {
    outcome_ = registration_.align(sweep_, surfels_, filter_);
    timer.done(Stage::registration);
  }
  moving_.find(sweep_, pose(), map_.free_space(), static_cast<float>(search_reach_));
  if (registers_) add_surfels();
  extrapolate_motion(before);
  levelling_.advance(sensors, step_, pose());
  update_attitude_error(predicted, was_silent);
  map_.add(sweep_, pose(), sweep.end_ns, reach());
  timer.done(Stage::map);
}

void Mapper::add_part(const Sweep& sweep, const SyncBuffer& sensors, StageTimer& timer) {
  DeadReckoning ahead = dead_reckoning_;
  PoseFilter filter = filter_;
  filter.predict(
      ahead.advance(sensors, begin_of(sweep), sweep.end_ns, trajectory_, !slip_detector_.slips()));
  part_pose_ = filter.pose();
  deskew(sweep, lidar_, trajectory_, own_returns_, sweep_, taken_);
  own_returns_.forget_sweep();
  taken_ = {sweep.turn, sweep.points.size(), sweep.empty.size()};
  timer.done(Stage::motion);
  moving_.find(sweep_, pose(), map_.free_space(), static_cast<float>(search_reach_));
  map_.add(sweep_, pose(), sweep.end_ns, reach());
  timer.done(Stage::map);
}

/// When its first point was measured.
std::int64_t Mapper::begin_of(const Sweep& sweep) {
  return sweep.end_ns + (sweep.points.empty() ? 0 : sweep.time_ns[0]);
}

/// Farther off an error of the attitude lifts points too much, metres.
double Mapper::reach() const {
  return attitude_error_ > 0 ? kMaxHeightError / attitude_error_
                             : std::numeric_limits<double>::infinity();
}

void Mapper::restart() {
  dead_reckoning_.restart();
  filter_ = {};
  part_pose_.reset();
  forget_ground();
}

void Mapper::change_sensors() {
  const Pose here = filter_.pose();
  restart();
  filter_ = PoseFilter(here);
}

void Mapper::forget_ground() {
  surfels_.clear();
  map_.clear();
  sweep_.take_all();
  taken_ = {};
}

void Mapper::take_still(const Sweep& sweep) {
  trajectory_.start(SweepTrajectory::kLongestStepNs);
  trajectory_.push_back({});
  deskew(sweep, lidar_, trajectory_, own_returns_, sweep_);
  own_returns_.end_sweep(0);
}

bool Mapper::notice_own_returns() {
  constexpr double kArm = 0.5;  // metres: as OwnReturns counts turns
  const bool is_known = step_.knows_distance && !slip_detector_.slips();
  const double way = is_known ? std::abs(step_.distance) + kArm * step_.rotation_angle() : 0;
  return own_returns_.end_sweep(static_cast<float>(way));
}

void Mapper::detect_slip(const SyncBuffer& sensors, std::int64_t end_ns) {
  slip_detector_.advance(sensors, dead_reckoning_.end_ns(), end_ns, dead_reckoning_.speed());
  if (slip_detector_.slips()) ++slips_;
  if (slip_detector_.slips() || !sensors.wheel_at(end_ns)) {
    dead_reckoning_.assume_speed(slip_detector_.speed());
  }
}

void Mapper::add_surfels() {
  const Eigen::Matrix3f rotation = pose().rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = pose().translation.cast<float>();
  const auto reach = static_cast<float>(surfel_reach_);
  for (std::size_t i = 0; i < sweep_.points.size(); ++i) {
    const Eigen::Vector3f in_base(sweep_.points.x[i], sweep_.points.y[i], sweep_.points.z[i]);
    if (in_base.squaredNorm() > reach * reach || sweep_.is_moving[i] != 0) continue;
    surfels_.add(rotation * in_base + translation);
  }
}

/// While the IMU is silent the attitude within a sweep is extrapolated; what registration makes of
/// the sweep's whole turn shows how well.
void Mapper::update_attitude_error(const Eigen::Quaterniond& predicted, bool was_silent) {
  constexpr double kKept = 0.5;  // each sweep
  if (!filter_.has_known_attitude() || (step_.knows_attitude && !was_silent)) {
    attitude_error_ = 0;
    return;
  }
  if (attitude_error_ == 0) attitude_error_ = kInitialAttitudeError;
  if (outcome_.key_points == 0) return;
  const double error = logarithm(predicted.conjugate() * pose().rotation).head<2>().norm();
  attitude_error_ = std::max(error, kKept * attitude_error_ + (1 - kKept) * error);
}

/// What registration made of the motion stands in for a silent sensor.
void Mapper::extrapolate_motion(const Pose& before) {
  constexpr double kTrust = 0.5;  // in the latest step
  const double seconds = step_.seconds();
  if (seconds <= 0 || outcome_.key_points == 0) return;
  if (!step_.knows_distance) {
    const Eigen::Vector3d ahead = pose().rotation * Eigen::Vector3d::UnitX();
    const double speed = (pose().translation - before.translation).dot(ahead) / seconds;
    const double assumed = dead_reckoning_.speed();
    dead_reckoning_.assume_speed(assumed + kTrust * (speed - assumed));
  }
  if (!step_.knows_attitude) {
    const Eigen::Vector3d rate = logarithm(before.rotation.conjugate() * pose().rotation) / seconds;
    const Eigen::Vector3d assumed = dead_reckoning_.rate();
    dead_reckoning_.assume_rate(assumed + kTrust * (rate - assumed));
  }
}

}  // namespace scree
