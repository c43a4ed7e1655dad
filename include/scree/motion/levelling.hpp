#pragma once

#include <Eigen/Core>

#include "scree/core/pose.hpp"
#include "scree/motion/dead_reckoning.hpp"
#include "scree/sync/sync_buffer.hpp"

namespace scree {

/// Lays the map's frame level. That frame took its vertical from the IMU's attitude at the first
/// sweep, and registration keeps what was wrong with it. The accelerometer knows the vertical too:
/// its specific force over a window of time, less the IMU's acceleration by wheel and attitude, is
/// gravity, but for its bias. A Kalman filter estimates the frame's tilt and that bias. The bias
/// turns with the robot, which tells it from the tilt.
class Levelling {
public:
  /// @param imu its origin in `base`, metres
  explicit Levelling(const Eigen::Vector3d& imu);

  /// Takes one step after the other. Where attitude, wheel or acceleration are missing the window
  /// begins anew.
  /// @param pose `base` in the map's frame at the step's end
  void advance(const SyncBuffer& sensors, const MotionStep& step, const Pose& pose);

  /// The map's frame in `odom`. It changes by turns about the robot, which so never jumps.
  const Pose& to_odom() const { return to_odom_; }

private:
  static constexpr int kStates = 4;  // the tilt about x and y (rad), the bias along x and y (m/s^2)
  using States = Eigen::Matrix<double, kStates, 1>;

  /// Integrals over a part of the way, in the map's frame.
  struct Integrals {
    Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();  ///< m/s
    Eigen::Matrix2d heading = Eigen::Matrix2d::Zero();  ///< x and y of `base` seen from above, s
    double seconds = 0;
    void operator+=(const Integrals& other);
  };
  void update(const Eigen::Vector3d& velocity_change, const Eigen::Vector3d& robot);

  Eigen::Vector3d imu_;
  States states_ = States::Zero();
  Eigen::Matrix<double, kStates, kStates> covariance_;
  Integrals window_;                                           // since ...
  Eigen::Vector3d velocity_before_ = Eigen::Vector3d::Zero();  // ... the IMU had this, m/s
  bool has_window_ = false;
  Pose to_odom_;
};

}  // namespace scree
