#pragma once

#include <Eigen/Geometry>
#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "scree/motion/sweep_trajectory.hpp"
#include "scree/sync/sync_buffer.hpp"

namespace scree {

/// How `base` moved from one instant to another, by IMU and encoder alone. The `level` frame is the
/// IMU's own: gravity-aligned, with a yaw that drifts. It is the one at the step's end: the path
/// that was extrapolated while the IMU was silent is rotated into it when the IMU speaks again.
struct MotionStep {
  std::int64_t begin_ns = 0, end_ns = 0;
  Eigen::Quaterniond begin_attitude = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< of `base` in `level`, at end
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();        ///< in `level`, metres
  double distance = 0;  ///< by the wheel, or extrapolated; metres, backwards below zero
  bool knows_attitude = false, knows_distance = false;  ///< measured up to the end
  double attitude_walk = 0;                             ///< see SyncBuffer
  /// Not below zero, and little more than DeadReckoning::kLongestWaitNs.
  double seconds() const { return static_cast<double>(end_ns - begin_ns) * 1e-9; }
  /// Angle between the attitudes, rad.
  double rotation_angle() const { return begin_attitude.angularDistance(attitude); }
};

/// Dead reckoning of `base`: attitude from the IMU, distance from the encoder along the x axis of
/// `base` (no slip to the sides), less what the wheel rolls because the robot turns. Where a sensor
/// is silent the last angular rate or speed is kept, or what is assumed instead.
class DeadReckoning {
public:
  /// After a longer wait for the next end, or where it is not later than the last, the clock was
  /// set or the lidar was away. The motion then goes on at `begin_ns`, with the displacement and
  /// the rotation that the sensors have seen meanwhile, and with none where they are silent.
  static constexpr std::int64_t kLongestWaitNs = 10'000'000'000;

  /// @param imu_mount rotation imu -> base
  /// @param wheel where it touches the ground, in `base`, metres
  explicit DeadReckoning(const Eigen::Quaterniond& imu_mount,
                         const Eigen::Vector3d& wheel = Eigen::Vector3d::Zero())
      : imu_mount_(imu_mount), wheel_place_(wheel) {}

  /// Goes from the end of the last step (the first: `begin_ns`) to `end_ns`.
  /// @param trajectory gets the last 0.3 s of it at most
  /// @param trusts_wheel else the encoder counts as silent
  MotionStep advance(const SyncBuffer& sensors, std::int64_t begin_ns, std::int64_t end_ns,
                     SweepTrajectory& trajectory, bool trusts_wheel = true);

  /// As if it had never gone.
  void restart();

  /// What a silent sensor would have measured, by whoever knows better.
  void assume_rate(const Eigen::Vector3d& rate) { rate_ = rate; }  ///< rad/s, `base`
  void assume_speed(double speed) { speed_ = speed; }              ///< m/s
  const Eigen::Vector3d& rate() const { return rate_; }
  double speed() const { return speed_; }
  /// The end of the last step.
  std::int64_t end_ns() const { return now_ns_; }

private:
  struct State {
    Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    bool knows_attitude = false, knows_distance = false;
  };
  std::int64_t begin_step(const SyncBuffer& sensors, std::int64_t begin_ns, std::int64_t end_ns);
  std::int64_t integrate_step(const SyncBuffer& sensors, std::int64_t end_ns);
  void integrate_to(const SyncBuffer& sensors, std::int64_t t_ns);
  void rotate_step(const Eigen::Quaterniond& rotation);
  void write(SweepTrajectory& trajectory, std::int64_t step_ns) const;

  Eigen::Quaterniond imu_mount_;
  Eigen::Vector3d wheel_place_;
  State state_, begin_;  // now, and at the begin of the step under way; positions since then
  std::int64_t now_ns_ = 0;
  double wheel_ = 0;     // its distance at now_ns_, while that is known
  double distance_ = 0;  // of the step under way
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();
  double speed_ = 0;
  bool started_ = false, trusts_wheel_ = true;
  // For the trajectory, oldest first.
  boost::container::static_vector<State, SweepTrajectory::kMaxSteps + 1> states_;
};

}  // namespace scree
