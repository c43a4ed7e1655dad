#pragma once

#include <Eigen/Core>

#include "scree/core/pose.hpp"
#include "scree/motion/iterated_update.hpp"
#include "scree/motion/sweep_trajectory.hpp"

namespace scree {

/// The pose and the velocities of a lidar by its sweeps alone: an iterated extended Kalman filter
/// that expects the velocities to stay. Its frame is that of the lidar at the first sweep. Beside
/// PoseFilter it knows nothing of IMU, encoder and mounts, so that these can be held against it.
///
/// Its errors, in order: position (3, m), rotation vector (3, rad), velocity (3, m/s) and angular
/// rate (3, rad/s), all in its frame.
class TwistFilter {
public:
  static constexpr int kErrors = 12;
  using Evidence = TwistEvidence;
  using Errors = Eigen::Matrix<double, kErrors, 1>;
  using Covariance = Eigen::Matrix<double, kErrors, kErrors>;

  TwistFilter();

  void predict(double seconds);
  // As those of PoseFilter.
  void begin_update();
  double update(const TwistEvidence& evidence);
  void end_update(const TwistEvidence& evidence);
  const Pose& pose() const { return pose_; }
  const Covariance& covariance() const { return covariance_; }
  bool knows_attitude() const { return false; }

  /// Where a point of a sweep is, in the filter's frame, and how its distance along a direction
  /// there changes with the errors. A sweep was bent by the velocities that were predicted; what is
  /// corrected of its swing, up and down and about level axes, unbends it (as CT-ICP does,
  /// Dellenbach et al. 2022). The ground does not show the other velocities so well: unbent by
  /// them, too, the yaw runs away on smooth ground.
  /// @param point in the lidar's frame at the sweep's end, by write()'s trajectory
  /// @param before_s how long before the end it was measured
  Eigen::Vector3d place(const Eigen::Vector3d& point, double before_s) const;
  Errors jacobian(const Eigen::Vector3d& point, double before_s,
                  const Eigen::Vector3d& direction) const;

  /// Where the lidar was during the last `seconds`, by the velocities.
  void write(SweepTrajectory& trajectory, double seconds) const;
  /// The standard deviation of the velocity along a direction of the lidar's frame, m/s.
  double speed_deviation(const Eigen::Vector3d& direction) const;

private:
  void apply(const Errors& error);

  Pose pose_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero(), rate_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d predicted_velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d predicted_rate_ = Eigen::Vector3d::Zero();
  Covariance covariance_ = Covariance::Zero();
  IteratedUpdate<kErrors> update_;
};

}  // namespace scree
