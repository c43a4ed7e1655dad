#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "scree/sync/sync_buffer.hpp"

namespace scree {

/// Tells when the wheel turns otherwise than the robot moves: it spins, it is blocked, or its
/// counter stands. The IMU feels whatever makes the robot faster or slower; a wheel whose speed
/// leaves that behind is not believed until it agrees again.
class SlipDetector {
public:
  /// @param mount rotation imu -> base
  /// @param origin of the IMU in `base`, metres
  /// @param max_speed of the robot, m/s
  /// @param wheel where it touches the ground, in `base`, metres
  SlipDetector(const Eigen::Quaterniond& mount, const Eigen::Vector3d& origin, double max_speed,
               const Eigen::Vector3d& wheel = Eigen::Vector3d::Zero())
      : mount_(mount), origin_(origin), max_speed_(max_speed), wheel_place_(wheel) {}

  /// Takes one interval after the other. Without acceleration, or after an interval too long to say
  /// anything, the wheel is believed.
  /// @param speed of the robot at begin_ns along x of `base`, as far as others know it, m/s: taken
  /// up where the wheel is silent or not believed
  void advance(const SyncBuffer& sensors, std::int64_t begin_ns, std::int64_t end_ns, double speed);

  bool slips() const { return slips_; }
  /// The robot's at the end of the last interval, along x of `base`, m/s.
  double speed() const { return speed_; }

private:
  std::optional<double> wheel_speed(const SyncBuffer& sensors, std::int64_t begin_ns,
                                    std::int64_t end_ns) const;
  void compare(double wheel, double seconds);

  Eigen::Quaterniond mount_;
  Eigen::Vector3d origin_;
  double max_speed_;
  Eigen::Vector3d wheel_place_;
  double speed_ = 0;
  double agreed_s_ = 0, slipped_s_ = 0;  // how long it has done so
  bool is_known_ = false, slips_ = false;
};

}  // namespace scree
