#include "scree/motion/pose_filter.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scree/core/rotation.hpp"

namespace scree {
namespace {

// Standard deviations of what dead reckoning gets wrong.
constexpr double kTiltSeconds = 20;    // the IMU's roll and pitch wander this fast
constexpr double kYawWalk = 0.0005;    // rad in a square root of a second
constexpr double kDrift = 0.001;       // of the yaw, rad/s
constexpr double kDriftWalk = 0.001;   // rad/s in a square root of a second: heading filters wander
constexpr double kScale = 0.015;       // of the wheel's circumference
constexpr double kScaleWalk = 0.001;   // in a square root of a metre
constexpr double kSlip = 0.02;         // along the way, metres in a square root of a metre ...
constexpr double kSideSlip = 0.006;    // ... across it ...
constexpr double kHeave = 0.008;       // ... and upwards
constexpr double kShake = 0.001;       // metres in each direction each step
constexpr double kSilentTurn = 0.08;   // while the IMU is silent, rad in a square root of a second
constexpr double kSilentTilt = 0.032;  // the same of roll and pitch
constexpr double kSilentWay = 0.13;    // while the encoder is, metres in a square root of a second
constexpr double kAnotherYaw = 0.04;   // rad: an IMU that comes back this far off, ...
constexpr double kSurely = 3;          // ... and so many standard deviations, has restarted ...
constexpr double kAnotherYawError = 0.05;  // ... and takes up the yaw this well, rad

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

/// Rad, +-pi.
double yaw_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  return std::remainder(yaw_of(to) - yaw_of(from), 2 * std::numbers::pi);
}

/// As the IMU says, rad.
double yawed_in(const MotionStep& step) {
  return yaw_between(step.begin_attitude, step.attitude);
}

bool is_still(const MotionStep& step) {
  constexpr double kMostWay = 0.002;  // metres a step: no more than a count or two of the wheel
  constexpr double kMostTurn = 0.01;  // rad/s of yaw: an IMU drifts less, a robot turns faster
  return step.knows_attitude && step.knows_distance && std::abs(step.distance) < kMostWay &&
         std::abs(yawed_in(step)) < kMostTurn * step.seconds();
}

}  // namespace

void PoseFilter::predict(const MotionStep& step) {
  if (!started_) {
    started_ = true;
    level_ = exponential({0, 0, -yaw_of(step.attitude)});
    attitude_ = step.attitude;
    pose_ = {Eigen::Vector3d::Zero(), level_ * step.attitude};
    covariance_.setZero();
    covariance_(3, 3) = covariance_(4, 4) = square(kTilt);
    covariance_(6, 6) = square(kScale);
    covariance_(7, 7) = square(kDrift);
    knew_attitude_ = step.knows_attitude;
    if (knew_attitude_) return;
    covariance_(3, 3) = covariance_(4, 4) = square(0.1);
    return;
  }
  const double seconds = step.seconds();
  if (knew_attitude_ && !step.knows_attitude) {
    level_before_ = level_;
    tilt_before_ = std::max(covariance_(3, 3), covariance_(4, 4));
    yaw_before_ = covariance_(5, 5);
    silent_s_ = 0;
    has_known_attitude_ = true;
  }
  if (!step.knows_attitude) silent_s_ += seconds;
  const bool is_back = !knew_attitude_ && step.knows_attitude;
  if (is_back) join(step);
  const bool is_at_rest = knew_attitude_ && is_still(step);
  knew_attitude_ = step.knows_attitude;
  constexpr double kStandingAfter = 0.3;  // seconds: the body has come to rest
  standing_s_ = is_at_rest ? standing_s_ + seconds : 0;
  const bool stands = standing_s_ > kStandingAfter;
  if (stands) stand(step);
  const double drifting_s = stands ? 0 : seconds;  // that the yaw goes on by the IMU alone

  const Eigen::Vector3d moved = level_ * step.displacement * (1 + scale_);
  level_ = exponential({0, 0, drift_ * drifting_s}) * level_;
  const double kept = std::exp(-seconds / kTiltSeconds);
  if (step.knows_attitude) level_ = exponential((1 - kept) * tilt_of(level_)) * level_;

  Covariance transition = Covariance::Identity();
  transition.block<3, 3>(0, 3) = -cross(moved);
  transition.block<3, 1>(0, 6) = moved / (1 + scale_);
  transition(5, 7) = drifting_s;
  if (step.knows_attitude) {
    transition(3, 3) = transition(4, 4) = kept;
  }
  covariance_ = transition * covariance_ * transition.transpose();

  const double distance = std::abs(step.distance);
  const Eigen::Matrix3d to_map = (level_ * step.attitude).toRotationMatrix();
  Eigen::Vector3d way(square(kSlip) * distance, square(kSideSlip) * distance,
                      square(kHeave) * distance);
  way.array() += square(kShake);
  if (!step.knows_distance) {
    way.x() += square(kSilentWay) * seconds;
  }
  covariance_.block<3, 3>(0, 0) += to_map * way.asDiagonal() * to_map.transpose();
  if (step.knows_attitude) {
    const double wander = square(kTilt) * (1 - square(kept));
    covariance_(3, 3) += wander;
    covariance_(4, 4) += wander;
    covariance_(5, 5) += square(kYawWalk) * drifting_s;
  } else {
    covariance_(3, 3) += square(kSilentTilt) * seconds;
    covariance_(4, 4) += square(kSilentTilt) * seconds;
    covariance_(5, 5) += square(kSilentTurn) * seconds;
  }
  covariance_(6, 6) += square(kScaleWalk) * distance;
  covariance_(7, 7) += square(kDriftWalk) * seconds;

  attitude_ = step.attitude;
  pose_.translation += moved;
  pose_.rotation = (level_ * attitude_).normalized();
}

/// A robot that stands does not turn: its yaw stays, and the turn that the IMU sees is its drift.
void PoseFilter::stand(const MotionStep& step) {
  const double yawed = yawed_in(step), seconds = step.seconds();
  const double noise = square(kYawWalk) / seconds;
  const Errors gain = covariance_.col(7) / (covariance_(7, 7) + noise);
  apply(gain * (-yawed / seconds - drift_));
  covariance_ -= (gain * covariance_.row(7)).eval();
  level_ = exponential({0, 0, -yawed}) * level_;
}

/// Takes up the level frame of an IMU that speaks again.
void PoseFilter::join(const MotionStep& step) {
  // Its yaw went on while it was silent, unless it started over, or was never heard before.
  const Eigen::Quaterniond gone_on = exponential({0, 0, drift_ * silent_s_}) * level_before_;
  const Eigen::Quaterniond believed =
      pose_.rotation * step.begin_attitude.conjugate() * step.attitude;
  const double turned = yaw_between(believed, gone_on * step.attitude);
  const double yaw_gone_on = yaw_before_ + square(kDrift * silent_s_);
  const double off = std::max(kAnotherYaw, kSurely * std::sqrt(covariance_(5, 5) + yaw_gone_on));
  const bool goes_on = has_known_attitude_ && std::abs(turned) < off;
  const double yaw = goes_on ? yaw_gone_on : covariance_(5, 5) + square(kAnotherYawError);
  level_ = goes_on ? gone_on : exponential({0, 0, yaw_of(believed) - yaw_of(step.attitude)});
  covariance_.block<3, kErrors>(3, 0).setZero();
  covariance_.block<kErrors, 3>(0, 3).setZero();
  covariance_(3, 3) = covariance_(4, 4) = std::max(tilt_before_, square(kTilt));
  covariance_(5, 5) = yaw;
}

void PoseFilter::begin_update() {
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  covariance_.diagonal().array() += 1e-12;
  prior_ = covariance_.inverse();
  applied_.setZero();
}

double PoseFilter::update(const PoseEvidence& evidence) {
  Covariance information = prior_;
  information.topLeftCorner<6, 6>() += evidence.information;
  Errors gradient = prior_ * applied_;
  gradient.head<6>() += evidence.gradient;
  const Errors correction = -information.llt().solve(gradient);
  if (!correction.allFinite()) return 0;
  apply(correction);
  applied_ += correction;
  return correction.head<6>().norm();
}

void PoseFilter::end_update(const PoseEvidence& evidence) {
  Covariance information = prior_;
  information.topLeftCorner<6, 6>() += evidence.information;
  covariance_ = information.inverse();
}

void PoseFilter::apply(const Errors& error) {
  pose_.translation += error.head<3>();
  level_ = (exponential(error.segment<3>(3)) * level_).normalized();
  pose_.rotation = (level_ * attitude_).normalized();
  scale_ += error[6];
  drift_ += error[7];
}

}  // namespace scree
