#include "scree/motion/pose_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scree/core/rotation.hpp"

namespace scree {
namespace {

// Standard deviations of what dead reckoning gets wrong. Chosen on simulated drives; the IMU's are
// of the size that the simulator gives an MTi.
constexpr double kTiltSeconds = 20;    // the errors of roll and pitch are correlated this long
constexpr double kUnknownTilt = 0.1;   // rad: no IMU has been heard yet
constexpr double kYawWalk = 0.0005;    // rad in a square root of a second
constexpr double kDrift = 0.001;       // of the yaw, rad/s
constexpr double kDriftWalk = 0.001;   // rad/s in a square root of a second: heading filters wander
constexpr double kScale = 0.015;       // of the wheel's circumference
constexpr double kScaleWalk = 0.001;   // in a square root of a metre
constexpr double kSlipNoise = 0.02;    // along the way, metres in a square root of a metre ...
constexpr double kSideSlip = 0.006;    // ... across it ...
constexpr double kHeave = 0.008;       // ... and upwards
constexpr double kShake = 0.001;       // metres in each direction each step
constexpr double kSilentTurn = 0.08;   // while the IMU is silent, rad in a square root of a second
constexpr double kSilentTilt = 0.032;  // the same of roll and pitch
constexpr double kSilentWay = 0.13;    // while the encoder is, metres in a square root of a second
constexpr double kRestartYaw = 0.04;   // rad: an IMU that comes back this far off, ...
constexpr double kRestartSigmas = 3;   // ... and so many standard deviations, has restarted ...
constexpr double kRestartYawError = 0.05;  // ... and takes up the yaw this well, rad

double square(double value) {
  return value * value;
}

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

/// What turns the vertical of a frame, nearly upright, into that of the map's frame.
Eigen::Vector3d tilt_of(const Eigen::Quaterniond& frame) {
  const Eigen::Vector3d up = frame * Eigen::Vector3d::UnitZ();
  return {up.y(), -up.x(), 0};
}

/// The yaw from one attitude to the other, rad, within +-pi.
double yaw_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  return std::remainder(yaw_of(to) - yaw_of(from), 2 * std::numbers::pi);
}

/// By the IMU, rad.
double yaw_change_of(const MotionStep& step) {
  return yaw_between(step.begin_attitude, step.attitude);
}

bool is_still(const MotionStep& step) {
  constexpr double kMaxWay = 0.002;  // metres a step: no more than a count or two of the wheel
  constexpr double kMaxTurn = 0.01;  // rad/s of yaw: an IMU drifts less, a robot turns faster
  return step.knows_attitude && step.knows_distance && std::abs(step.distance) < kMaxWay &&
         std::abs(yaw_change_of(step)) < kMaxTurn * step.seconds();
}

}  // namespace

void PoseFilter::start(const MotionStep& step) {
  started_ = true;
  const double yaw =
      goes_on_ ? yaw_of(pose_.rotation) - yaw_of(step.begin_attitude) : -yaw_of(step.attitude);
  level_ = exponential({0, 0, yaw});
  attitude_ = step.attitude;
  if (goes_on_) pose_.translation += level_ * step.displacement;
  pose_.rotation = level_ * step.attitude;
  knew_attitude_ = step.knows_attitude;
  covariance_.setZero();
  covariance_(3, 3) = covariance_(4, 4) = square(knew_attitude_ ? kTilt : kUnknownTilt);
  covariance_(6, 6) = square(kScale);
  covariance_(7, 7) = square(kDrift);
}

void PoseFilter::predict(const MotionStep& step) {
  if (!started_) return start(step);
  watch_silence(step);
  const bool is_at_rest = watch_rest(step);
  knew_attitude_ = step.knows_attitude;
  if (is_at_rest) update_zero_rate(step);

  const double seconds = step.seconds();
  const double drift_seconds = is_at_rest ? 0 : seconds;  // the yaw goes on by the IMU alone
  const double tilt_kept = std::exp(-seconds / kTiltSeconds);
  const Eigen::Vector3d displacement = level_ * step.displacement * (1 + scale_);
  level_ = exponential({0, 0, drift_ * drift_seconds}) * level_;
  if (step.knows_attitude) level_ = exponential((1 - tilt_kept) * tilt_of(level_)) * level_;

  Covariance transition = Covariance::Identity();
  transition.block<3, 3>(0, 3) = -cross(displacement);
  transition.block<3, 1>(0, 6) = displacement / (1 + scale_);
  transition(5, 7) = drift_seconds;
  if (step.knows_attitude) transition(3, 3) = transition(4, 4) = tilt_kept;
  covariance_ = transition * covariance_ * transition.transpose();
  add_position_noise(step);
  add_noise(step, drift_seconds, tilt_kept);

  attitude_ = step.attitude;
  pose_.translation += displacement;
  pose_.rotation = (level_ * attitude_).normalized();
}

/// Keeps what was known of the level frame when the IMU falls silent. Realigns the frame when the
/// IMU speaks again.
void PoseFilter::watch_silence(const MotionStep& step) {
  if (knew_attitude_ && !step.knows_attitude) {
    level_before_ = level_;
    tilt_before_ = std::max(covariance_(3, 3), covariance_(4, 4));
    yaw_before_ = covariance_(5, 5);
    silent_s_ = 0;
    has_known_attitude_ = true;
  }
  if (!step.knows_attitude) silent_s_ += step.seconds();
  if (!knew_attitude_ && step.knows_attitude) realign_level_frame(step);
}

/// Whether the robot stands, and has done so for a while.
bool PoseFilter::watch_rest(const MotionStep& step) {
  constexpr double kRestAfter = 0.3;  // seconds: the body has come to rest
  rest_s_ = knew_attitude_ && is_still(step) ? rest_s_ + step.seconds() : 0;
  return rest_s_ > kRestAfter;
}

/// A wheel slips along and across its way, and rough ground lifts the robot.
void PoseFilter::add_position_noise(const MotionStep& step) {
  const double distance = std::abs(step.distance);
  const Eigen::Matrix3d to_map = (level_ * step.attitude).toRotationMatrix();
  Eigen::Vector3d variances(square(kSlipNoise) * distance, square(kSideSlip) * distance,
                            square(kHeave) * distance);
  variances.array() += square(kShake);
  if (!step.knows_distance) variances.x() += square(kSilentWay) * step.seconds();
  covariance_.block<3, 3>(0, 0) += to_map * variances.asDiagonal() * to_map.transpose();
}

void PoseFilter::add_noise(const MotionStep& step, double drift_seconds, double tilt_kept) {
  const double seconds = step.seconds();
  if (step.knows_attitude) {
    const double tilt = square(kTilt) * (1 - square(tilt_kept));
    covariance_.diagonal().segment<3>(3).array() += square(step.attitude_walk) * seconds;
    covariance_(3, 3) += tilt;
    covariance_(4, 4) += tilt;
    covariance_(5, 5) += square(kYawWalk) * drift_seconds;
  } else {
    covariance_(3, 3) += square(kSilentTilt) * seconds;
    covariance_(4, 4) += square(kSilentTilt) * seconds;
    covariance_(5, 5) += square(kSilentTurn) * seconds;
  }
  covariance_(6, 6) += square(kScaleWalk) * std::abs(step.distance);
  covariance_(7, 7) += square(kDriftWalk) * seconds;
}

/// A zero-angular-rate update: a robot that stands does not turn. Its yaw stays, and the turn that
/// the IMU sees is its drift.
void PoseFilter::update_zero_rate(const MotionStep& step) {
  const double yaw_change = yaw_change_of(step), seconds = step.seconds();
  const double noise = square(kYawWalk) / seconds;
  const Errors gain = covariance_.col(7) / (covariance_(7, 7) + noise);
  apply(gain * (-yaw_change / seconds - drift_));
  covariance_ -= (gain * covariance_.row(7)).eval();
  level_ = exponential({0, 0, -yaw_change}) * level_;
}

/// Takes up the level frame of an IMU that speaks again. Its yaw went on while it was silent,
/// unless it has restarted, or was never heard before.
void PoseFilter::realign_level_frame(const MotionStep& step) {
  const Eigen::Quaterniond continued = exponential({0, 0, drift_ * silent_s_}) * level_before_;
  const Eigen::Quaterniond believed =
      pose_.rotation * step.begin_attitude.conjugate() * step.attitude;
  const double apart = yaw_between(believed, continued * step.attitude);
  const double continued_variance = yaw_before_ + square(kDrift * silent_s_);
  const double limit =
      std::max(kRestartYaw, kRestartSigmas * std::sqrt(covariance_(5, 5) + continued_variance));
  const bool goes_on = has_known_attitude_ && std::abs(apart) < limit;
  const double yaw_variance =
      goes_on ? continued_variance : covariance_(5, 5) + square(kRestartYawError);
  level_ = goes_on ? continued : exponential({0, 0, yaw_of(believed) - yaw_of(step.attitude)});
  covariance_.block<3, kErrors>(3, 0).setZero();
  covariance_.block<kErrors, 3>(0, 3).setZero();
  covariance_(3, 3) = covariance_(4, 4) = std::max(tilt_before_, square(kTilt));
  covariance_(5, 5) = yaw_variance;
}

void PoseFilter::begin_update() {
  update_.begin(covariance_);
}

double PoseFilter::update(const PoseEvidence& evidence) {
  const auto correction = update_.round(evidence);
  if (!correction) return 0;
  apply(*correction);
  return correction->head<6>().norm();
}

void PoseFilter::end_update(const PoseEvidence& evidence) {
  update_.end(evidence, covariance_);
}

void PoseFilter::apply(const Errors& error) {
  pose_.translation += error.head<3>();
  level_ = (exponential(error.segment<3>(3)) * level_).normalized();
  pose_.rotation = (level_ * attitude_).normalized();
  scale_ += error[6];
  drift_ += error[7];
}

}  // namespace scree
