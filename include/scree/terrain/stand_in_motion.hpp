#pragma once

#include <cstdint>

#include "scree/config/settings.hpp"
#include "scree/core/pose.hpp"
#include "scree/sync/sync_buffer.hpp"
#include "scree/terrain/lidar_odometry.hpp"

namespace scree {

/// What IMU and encoder would measure, by the lidar alone: stands in for an IMU that was never
/// heard, and for an encoder that is not. Memory is taken once, when it is made.
class StandInMotion {
public:
  explicit StandInMotion(const Settings& settings);

  /// Takes the odometry's last step.
  /// @param follows what LidarOdometry::add() said
  /// @param sensors what is heard of the real ones
  void add(const LidarOdometry& odometry, bool follows, const SyncBuffer& sensors);

  /// Samples up to the last sweep's end: the IMU's by the lidar, the encoder's by the encoder where
  /// it is heard. The level frame is level where the ground around the robot was at first.
  const SyncBuffer& samples() const { return samples_; }
  /// Whether the ground has shown how the lidar moves, within the last second. It is believed to at
  /// first, and after a pause.
  bool is_bound() const { return is_bound_; }
  /// Whether it did so with the last sweep for the first time: the motion before was a guess.
  bool settles() const { return settles_; }

private:
  void begin(const LidarOdometry& odometry);
  void put(const Eigen::Quaterniond& attitude, const Eigen::Vector3d& rate, double distance,
           std::int64_t t_ns);

  Pose mount_;  // of the lidar
  Eigen::Quaterniond imu_mount_;
  Eigen::Vector3d wheel_place_;
  SyncBuffer samples_;
  Eigen::Quaterniond attitude_ = Eigen::Quaterniond::Identity();  // of `base`
  double distance_ = 0;                                           // of the wheel, metres
  std::int64_t bound_ns_ = 0;                                     // when it was last bound
  bool has_begun_ = false, is_bound_ = false, is_settled_ = false, settles_ = false;
};

}  // namespace scree
