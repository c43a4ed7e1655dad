#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "scree/core/pose.hpp"
#include "scree/motion/dead_reckoning.hpp"
#include "scree/motion/iterated_update.hpp"

namespace scree {

/// The pose of `base` in the map's frame, and how well it is known: an iterated extended Kalman
/// filter. It predicts by dead reckoning; evidence from registration corrects it only in the
/// directions that the evidence binds. Beside the pose it estimates the encoder's scale and the
/// drift of the IMU's yaw. It does so while the robot stands, too: then its yaw stays as it is.
///
/// Its errors, in order: position in the map's frame (3, m), rotation vector in it (3, rad),
/// relative error of the encoder's scale, drift of the IMU's yaw (rad/s).
class PoseFilter {
public:
  static constexpr int kErrors = 8;
  static constexpr double kTilt = 0.006;  ///< standard deviation of the IMU's roll and pitch, rad
  using Evidence = PoseEvidence;
  using Errors = Eigen::Matrix<double, kErrors, 1>;
  using Covariance = Eigen::Matrix<double, kErrors, kErrors>;

  PoseFilter() = default;
  /// Goes on from a pose, by sensors with another level frame. @param pose where the first step
  /// begins; its yaw holds, its vertical does not
  explicit PoseFilter(const Pose& pose) : pose_(pose), goes_on_(true) {}

  /// Starts at the origin with the yaw of `attitude` as zero, unless it goes on from a pose. Later
  /// it takes a new attitude of the `level` frame at the same pose.
  void predict(const MotionStep& step);

  /// Begins an iterated update.
  void begin_update();
  /// One round of it. @param evidence linearised at pose()
  /// @return the size of the correction: metres plus radians
  double update(const PoseEvidence& evidence);
  /// @param evidence of the last round
  void end_update(const PoseEvidence& evidence);

  const Pose& pose() const { return pose_; }
  /// Where a point of `base` is in the map's frame, and how its distance along a direction there
  /// changes with position and rotation. The motion within a sweep is taken for known.
  Eigen::Vector3d place(const Eigen::Vector3d& point, double /*before_s*/) const {
    return pose_ * point;
  }
  Eigen::Matrix<double, 6, 1> jacobian(const Eigen::Vector3d& point, double /*before_s*/,
                                       const Eigen::Vector3d& direction) const {
    return pose_jacobian(pose_.rotation * point, direction);
  }
  /// Standard deviations.
  Eigen::Vector3d position_deviation() const {
    return covariance_.diagonal().head<3>().cwiseSqrt();
  }
  Eigen::Vector3d rotation_deviation() const {
    return covariance_.diagonal().segment<3>(3).cwiseSqrt();
  }
  const Covariance& covariance() const { return covariance_; }
  double scale_error() const { return scale_; }
  double yaw_drift() const { return drift_; }
  /// Whether the IMU has said how the latest step turned.
  bool knows_attitude() const { return knew_attitude_; }
  /// Whether the IMU has ever been heard.
  bool has_known_attitude() const { return has_known_attitude_ || knew_attitude_; }

private:
  void start(const MotionStep& step);
  void watch_silence(const MotionStep& step);
  bool watch_rest(const MotionStep& step);
  void update_zero_rate(const MotionStep& step);
  void realign_level_frame(const MotionStep& step);
  void add_position_noise(const MotionStep& step);
  void add_noise(const MotionStep& step, double drift_seconds, double tilt_kept);
  void apply(const Errors& error);

  Pose pose_;
  Eigen::Quaterniond level_ = Eigen::Quaterniond::Identity();  // the IMU's level frame in the map's
  Eigen::Quaterniond attitude_ = Eigen::Quaterniond::Identity();
  double scale_ = 0, drift_ = 0;
  Covariance covariance_ = Covariance::Zero();
  // While the IMU is silent.
  bool knew_attitude_ = false, has_known_attitude_ = false, started_ = false, goes_on_ = false;
  Eigen::Quaterniond level_before_ = Eigen::Quaterniond::Identity();
  double tilt_before_ = 0, yaw_before_ = 0;  // variances
  double silent_s_ = 0;
  double rest_s_ = 0;
  IteratedUpdate<kErrors> update_;
};

}  // namespace scree
