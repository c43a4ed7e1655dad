#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"
#include "scree/sync/sync_buffer.hpp"

namespace scree {

/// How `base` moved from one instant to another, by IMU and encoder alone. The `level` frame is the
/// IMU's own: gravity-aligned, with a yaw that drifts. It is the one at the end: what was guessed
/// while the IMU was silent is turned to join what it says when it speaks again.
struct MotionStep {
  std::int64_t begin_ns = 0, end_ns = 0;
  Eigen::Quaterniond begin_attitude = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< of `base` in `level`, at end
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();               ///< in `level`, metres
  double distance = 0;  ///< that the wheel says, or that was assumed; backwards below zero
  bool knows_attitude = false, knows_distance = false;  ///< measured up to the end
  /// Not below zero, and little more than DeadReckoning::kLongestWaitNs.
  double seconds() const { return static_cast<double>(end_ns - begin_ns) * 1e-9; }
  /// Angle between the attitudes, rad.
  double turned() const { return begin_attitude.angularDistance(attitude); }
};

/// Where `base` was during a sweep, in `base` at the sweep's end, in equal steps of time.
class MotionTrack {
public:
  static constexpr std::int64_t kLongestStepNs = 5'000'000;
  static constexpr std::size_t kMostSteps = 64;  ///< over the 0.22 s of the longest sweep

  struct Place {
    Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
    Eigen::Vector3f translation = Eigen::Vector3f::Zero();
  };

  /// Standing still.
  MotionTrack() : places_(kMostSteps + 1) { places_.push_back({}); }
  void start(std::int64_t step_ns) {
    places_.clear();
    step_ns_ = step_ns;
  }
  /// From the end backwards. False when full.
  bool push_back(const Place& place) { return places_.push_back(place); }
  /// @param before_end_ns not below zero; before the track's begin its first place answers
  Place at(std::int64_t before_end_ns) const;

private:
  FixedVector<Place> places_;
  std::int64_t step_ns_ = kLongestStepNs;
};

/// Follows the motion of `base` from instant to instant: attitude from the IMU, way from the
/// encoder along the x axis of `base` (no slip to the sides). Where a sensor is silent the last
/// angular rate or speed is carried on, or what is assumed instead.
class DeadReckoning {
public:
  /// After a longer wait for the next end, and after one that is not later than the last, the clock
  /// was set or the lidar was away: the motion goes on at `begin_ns`, with the way and the turn
  /// that the sensors have made meanwhile, and with none where they are silent.
  static constexpr std::int64_t kLongestWaitNs = 10'000'000'000;

  /// @param imu_mount rotation imu -> base
  explicit DeadReckoning(const Eigen::Quaterniond& imu_mount) : imu_mount_(imu_mount) {}

  /// From the end of the last step (the first: `begin_ns`) to `end_ns`.
  /// @param track the last 0.3 s of it at most
  /// @param trusts_wheel else the encoder counts as silent
  MotionStep advance(const SyncBuffer& sensors, std::int64_t begin_ns, std::int64_t end_ns,
                     MotionTrack& track, bool trusts_wheel = true);

  /// What a silent sensor would have said, by whoever knows better.
  void assume_rate(const Eigen::Vector3d& rate) { rate_ = rate; }  ///< rad/s, `base`
  void assume_speed(double speed) { speed_ = speed; }              ///< m/s
  const Eigen::Vector3d& rate() const { return rate_; }
  double speed() const { return speed_; }
  /// Of the last step.
  std::int64_t end_ns() const { return now_ns_; }

private:
  struct State {
    Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    bool knows_attitude = false, knows_distance = false;
  };
  void go_on(const SyncBuffer& sensors, std::int64_t t_ns);
  void turn(const Eigen::Quaterniond& rotation);

  Eigen::Quaterniond imu_mount_;
  State state_, begin_;  // now, and at the begin of the step under way
  std::int64_t now_ns_ = 0;
  double wheel_ = 0;     // its distance at now_ns_, while that is known
  double distance_ = 0;  // of the step under way
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();
  double speed_ = 0;
  bool started_ = false, trusts_wheel_ = true;
  FixedVector<State> states_{MotionTrack::kMostSteps + 1};
};

}  // namespace scree
