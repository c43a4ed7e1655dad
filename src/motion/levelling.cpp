#include "scree/motion/levelling.hpp"

#include <Eigen/LU>

#include "scree/core/gravity.hpp"
#include "scree/core/rotation.hpp"
#include "scree/motion/pose_filter.hpp"
#include "scree/motion/specific_force.hpp"

namespace scree {
namespace {

constexpr double kWindow = 1;  // seconds
// Standard deviations. Chosen on 143 simulated drives of 10 s, where the tilt of what is published
// falls from 7.5 to 4.0 mrad.
constexpr double kTilt = PoseFilter::kTilt;  // of the attitude of the first sweep, rad
constexpr double kTiltWalk = 0.0005;  // of the map's frame since then, rad in a square root of a s
constexpr double kBias = 0.03;        // of the accelerometer, m/s^2
constexpr double kNoise = 0.05;       // of a window: vibration, slip and the wheel's steps, m/s^2
constexpr double kGate = 5;           // a window that is farther off holds a shock

}  // namespace

void Levelling::Integrals::operator+=(const Integrals& other) {
  specific_force += other.specific_force;
  heading += other.heading;
  seconds += other.seconds;
}

Levelling::Levelling(const Eigen::Vector3d& imu) : imu_(imu) {
  covariance_.setZero();
  covariance_.diagonal() << kTilt * kTilt, kTilt * kTilt, kBias * kBias, kBias * kBias;
}

void Levelling::advance(const SyncBuffer& sensors, const MotionStep& step, const Pose& pose) {
  constexpr double kLongest = 0.5;  // seconds: of a step whose mean velocity says anything
  const double seconds = step.seconds();
  const bool is_known =
      step.knows_attitude && step.knows_distance && seconds > 0 && seconds < kLongest;
  const auto force =
      is_known ? integrate_specific_force(sensors.imu(), step.begin_ns, step.end_ns) : std::nullopt;
  if (!force) {
    has_window_ = false;
    return;
  }
  const Eigen::Quaterniond level = pose.rotation * step.attitude.conjugate();
  const Eigen::Vector3d swung = step.attitude * imu_ - step.begin_attitude * imu_;
  const Eigen::Vector3d velocity = level * (step.displacement + swung) / seconds;
  // The mean velocity is that of the step's middle: there one window ends and the next begins.
  const Integrals half{level * *force / 2,
                       pose.rotation.toRotationMatrix().topLeftCorner<2, 2>() * seconds / 2,
                       seconds / 2};
  if (has_window_) window_ += half;
  if (!has_window_ || window_.seconds >= kWindow) {
    if (has_window_) update(velocity - velocity_before_, pose.translation);
    has_window_ = true;
    window_ = {};
    velocity_before_ = velocity;
  }
  window_ += half;
}

/// The update of a Kalman filter: gravity in the map's frame is seen tilted, and with the bias.
/// @param velocity_change of the IMU over the window, m/s
/// @param robot about which the map's frame is turned
void Levelling::update(const Eigen::Vector3d& velocity_change, const Eigen::Vector3d& robot) {
  covariance_.topLeftCorner<2, 2>().diagonal().array() += kTiltWalk * kTiltWalk * window_.seconds;
  const Eigen::Vector2d gravity =
      ((window_.specific_force - velocity_change) / window_.seconds).head<2>();
  Eigen::Matrix<double, 2, kStates> jacobian;
  jacobian << 0, -kGravity, 0, 0, kGravity, 0, 0, 0;
  jacobian.rightCols<2>() = window_.heading / window_.seconds;
  const Eigen::Vector2d innovation = gravity - jacobian * states_;
  const Eigen::Matrix2d innovation_covariance =
      jacobian * covariance_ * jacobian.transpose() + kNoise * kNoise * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d inverse = innovation_covariance.inverse();
  if (!(innovation.dot(inverse * innovation) <= kGate * kGate)) return;
  const Eigen::Matrix<double, kStates, 2> gain = covariance_ * jacobian.transpose() * inverse;
  states_ += gain * innovation;
  covariance_ -= (gain * jacobian * covariance_).eval();

  const Eigen::Vector3d before = to_odom_ * robot;
  to_odom_.rotation = exponential({states_[0], states_[1], 0});
  to_odom_.translation = before - to_odom_.rotation * robot;
}

}  // namespace scree
