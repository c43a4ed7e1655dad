#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace scree {

/// One measurement of the IMU, in its own axes (`imu` frame).
/// What the device did not send is absent.
struct ImuSample {
  std::int64_t t_ns = 0;      ///< host time of the measurement
  bool started_over = false;  ///< the device, since the sample before
  bool has_orientation = false, has_rate = false, has_acceleration = false;
  /// `imu` in a gravity-aligned frame, z up, whose yaw need not be north.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();          ///< rad/s
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< specific force, m/s^2
};

/// Whether its numbers are finite, and its rate and acceleration below what any IMU of this class
/// can measure (MTi-600 and 700 data sheets: 2000 deg/s and 10 g an axis; others 20 g).
inline bool is_plausible(const ImuSample& sample) {
  constexpr double kMostRate = 70, kMostAcceleration = 350;
  return (!sample.has_rate || sample.rate.norm() < kMostRate) &&
         (!sample.has_acceleration || sample.acceleration.norm() < kMostAcceleration);
}

}  // namespace scree
