#include "scree/motion/levelling.hpp"

#include <Eigen/LU>

#include "felt.hpp"
#include "scree/core/rotation.hpp"
#include "scree/motion/pose_filter.hpp"

namespace scree {
namespace {

constexpr double kWindow = 1;  // seconds
// Standard deviations.
constexpr double kLean = PoseFilter::kTilt;  // of what the first sweep was laid by, rad ...
constexpr double kLeanWalk = 0.0005;         // ... and since then, rad in a square root of a second
constexpr double kBias = 0.03;               // of the accelerometer, m/s^2
constexpr double kNoise = 0.05;  // of a window: vibration, slip and the wheel's steps, m/s^2
constexpr double kFarthest = 5;  // in standard deviations: beyond it a window felt a shock

}  // namespace

void Levelling::Sums::operator+=(const Sums& other) {
  felt += other.felt;
  heading += other.heading;
  seconds += other.seconds;
}

Levelling::Levelling(const Eigen::Vector3d& imu) : imu_(imu) {
  covariance_.setZero();
  covariance_.diagonal() << kLean * kLean, kLean * kLean, kBias * kBias, kBias * kBias;
}

void Levelling::advance(const SyncBuffer& sensors, const MotionStep& step, const Pose& pose) {
  constexpr double kLongest = 0.5;  // seconds: of a step whose mean velocity says anything
  const double seconds = step.seconds();
  const bool is_known =
      step.knows_attitude && step.knows_distance && seconds > 0 && seconds < kLongest;
  const auto felt =
      is_known ? felt_during(sensors.imu(), step.begin_ns, step.end_ns) : std::nullopt;
  if (!felt) {
    has_window_ = false;
    return;
  }
  const Eigen::Quaterniond level = pose.rotation * step.attitude.conjugate();
  const Eigen::Vector3d swung = step.attitude * imu_ - step.begin_attitude * imu_;
  const Eigen::Vector3d velocity = level * (step.moved + swung) / seconds;
  // The mean velocity is that of the step's middle: there one window ends and the next begins.
  const Sums half{level * *felt / 2,
                  pose.rotation.toRotationMatrix().topLeftCorner<2, 2>() * seconds / 2,
                  seconds / 2};
  if (has_window_) window_ += half;
  if (!has_window_ || window_.seconds >= kWindow) {
    if (has_window_) learn(velocity - velocity_before_, pose.translation);
    has_window_ = true;
    window_ = {};
    velocity_before_ = velocity;
  }
  window_ += half;
}

/// @param faster by how much the IMU's velocity grew over the window, m/s
/// @param robot about which the map's frame is turned
void Levelling::learn(const Eigen::Vector3d& faster, const Eigen::Vector3d& robot) {
  covariance_.topLeftCorner<2, 2>().diagonal().array() += kLeanWalk * kLeanWalk * window_.seconds;
  const Eigen::Vector2d gravity = ((window_.felt - faster) / window_.seconds).head<2>();
  // What turns the map's frame by the lean brings up to where gravity says it is.
  Eigen::Matrix<double, 2, kStates> sees;
  sees << 0, -kGravity, 0, 0, kGravity, 0, 0, 0;
  sees.rightCols<2>() = window_.heading / window_.seconds;
  const Eigen::Vector2d off = gravity - sees * states_;
  const Eigen::Matrix2d expected =
      sees * covariance_ * sees.transpose() + kNoise * kNoise * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d inverse = expected.inverse();
  if (!(off.dot(inverse * off) <= kFarthest * kFarthest)) return;
  const Eigen::Matrix<double, kStates, 2> gain = covariance_ * sees.transpose() * inverse;
  states_ += gain * off;
  covariance_ -= (gain * sees * covariance_).eval();

  const Eigen::Vector3d place = to_odom_ * robot;
  to_odom_.rotation = exponential({states_[0], states_[1], 0});
  to_odom_.translation = place - to_odom_.rotation * robot;
}

}  // namespace scree
