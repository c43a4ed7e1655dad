#pragma once

#include <Eigen/Core>
#include <optional>

#include "scree/motion/ground_plane.hpp"

namespace scree {

/// Half a second as each sensor saw it, in its own frame.
struct SetupWindow {
  static constexpr double kBefore = 0.1;  // seconds

  double seconds = 0;
  /// By the lidar alone, in `lidar`: the way (m) and the rotation vector (rad). They are good only
  /// where the ground binds them.
  Eigen::Vector3d way = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();
  bool is_bound = false;
  bool binds = false;  ///< the same by the lidar's own word, which may have lost its way
  std::optional<GroundPlane> around,
      below;  ///< of the lidar, and of the robot's middle, in `lidar`

  bool has_imu = false, has_force = false;
  Eigen::Vector3d imu_turn = Eigen::Vector3d::Zero();         ///< rotation vector, `imu`, rad
  Eigen::Vector3d imu_turn_before = Eigen::Vector3d::Zero();  ///< kBefore earlier
  Eigen::Vector3d imu_up = Eigen::Vector3d::UnitZ();          ///< the vertical, `imu`
  Eigen::Vector3d imu_force = Eigen::Vector3d::Zero();        ///< less gravity, `imu`, m/s^2

  bool has_wheel = false;
  double wheel = 0;         ///< metres that it rolled
  double wheel_before = 0;  ///< kBefore earlier
};

/// However they are mounted, lidar and IMU turn by the same angle. Else registration has lost its
/// way. Rotation vectors, rad.
bool turn_alike(const Eigen::Vector3d& lidar, const Eigen::Vector3d& imu);

}  // namespace scree
