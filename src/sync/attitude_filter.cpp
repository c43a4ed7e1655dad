#include "scree/sync/attitude_filter.hpp"

#include <Eigen/LU>
#include <utility>

#include "scree/core/gravity.hpp"
#include "scree/core/rotation.hpp"

namespace scree {
namespace {

constexpr std::int64_t kWindowNs = 250'000'000;
constexpr std::int64_t kWheelNs = 200'000'000;  // so late the wheel's samples come at most
constexpr double kGap = 0.15;                   // seconds without a sample: it begins anew
constexpr std::int64_t kFirstNs = 3'000'000'000;
constexpr double kLevelled = 0.02;        // rad: the deviation from which on it answers ...
constexpr double kFirstLevelled = 0.012;  // ... in the first time: a map begins upright or never is

// Standard deviations.
constexpr double kFirstTilt = 0.3;     // by one sample's specific force, rad
constexpr double kOwnTilt = 0.01;      // of an orientation that the IMU sent, rad
constexpr double kFirstBias = 0.005;   // rad/s: 0.2 degrees/s in the data sheet of the MTi-1
constexpr double kBiasWalk = 3e-5;     // rad/s in the square root of a second
constexpr double kRateNoise = 0.001;   // rad in the square root of a second, with vibration
constexpr double kWithWheel = 0.19;    // of a window: slip, bumps and vibration, m/s^2
constexpr double kWithoutWheel = 0.7;  // ... and what the robot speeds up

double elapsed(std::int64_t since_ns, std::int64_t now_ns) {
  return static_cast<double>(now_ns - since_ns) * 1e-9;
}

bool goes_on(double seconds) {
  return seconds > 0 && seconds < kGap;
}

}  // namespace

void AttitudeFilter::restart() {
  has_turned_ = is_level_ = has_bound_ = waits_ = false;
  bias_.setZero();
}

bool AttitudeFilter::complete(ImuSample& sample, const Speed& speed) {
  if (sample.has_orientation) {
    go_on_from(sample);
    return true;
  }
  if (sample.has_rate) turn(sample);
  if (sample.has_acceleration) push(sample.acceleration, sample.t_ns);
  if (waits_ && sample.t_ns - end_.t_ns >= kWheelNs) close_window(speed);
  const double limit = sample.t_ns - begin_ns_ < kFirstNs ? kFirstLevelled : kLevelled;
  const bool is_known = is_level_ && sample.t_ns - begin_ns_ >= kWithoutNs &&
                        covariance_(0, 0) + covariance_(1, 1) < 2 * limit * limit;
  if (!sample.has_rate || !is_known) return false;
  sample.orientation = orientation_;
  sample.rate = rate_;
  sample.has_orientation = true;
  answers_ = true;
  return true;
}

/// Should it be the last one.
void AttitudeFilter::go_on_from(const ImuSample& sample) {
  restart();
  answers_ = false;
  orientation_ = sample.orientation.normalized();
  rate_ = sample.rate;
  has_turned_ = sample.has_rate;
  begin_ns_ = turned_ns_ = pushed_ns_ = sample.t_ns;
  begin_with(kOwnTilt);
}

void AttitudeFilter::begin_with(double tilt) {
  covariance_.setZero();
  covariance_.diagonal().head<2>().setConstant(tilt * tilt);
  covariance_.diagonal().tail<3>().setConstant(kFirstBias * kFirstBias);
  force_.setZero();
  is_level_ = true;
}

/// Turns by the mean of two rates, each less the bias.
void AttitudeFilter::turn(const ImuSample& sample) {
  const Eigen::Vector3d before = rate_;
  rate_ = sample.rate - bias_;
  const double seconds = elapsed(turned_ns_, sample.t_ns);
  turned_ns_ = sample.t_ns;
  if (!has_turned_ || !goes_on(seconds)) {
    is_level_ = has_bound_ = waits_ = false;
    has_turned_ = true;
    return;
  }
  orientation_ = (orientation_ * exponential((before + rate_) / 2 * seconds)).normalized();
  if (!is_level_) return;
  Eigen::Matrix<double, kStates, kStates> transition =
      Eigen::Matrix<double, kStates, kStates>::Identity();
  transition.topRightCorner<2, 3>() = -seconds * orientation_.toRotationMatrix().topRows<2>();
  covariance_ = (transition * covariance_ * transition.transpose()).eval();
  covariance_.diagonal().head<2>().array() += kRateNoise * kRateNoise * seconds;
  covariance_.diagonal().tail<3>().array() += kBiasWalk * kBiasWalk * seconds;
}

/// Integrates over windows; the first sample says where about up is.
void AttitudeFilter::push(const Eigen::Vector3d& specific_force, std::int64_t t_ns) {
  const double seconds = elapsed(pushed_ns_, t_ns);
  pushed_ns_ = t_ns;
  const Eigen::Vector3d force = orientation_ * specific_force;
  if (!is_level_) {
    if (!has_turned_) return;
    orientation_ =
        (Eigen::Quaterniond::FromTwoVectors(force, Eigen::Vector3d::UnitZ()) * orientation_)
            .normalized();
    begin_ns_ = t_ns;
    begin_with(kFirstTilt);
    return;
  }
  if (!goes_on(seconds)) {
    has_bound_ = waits_ = false;
    return;
  }
  force_ += force * seconds;
  if (has_bound_ && (waits_ || t_ns - end_.t_ns < kWindowNs)) return;
  const Bound bound{t_ns, orientation_ * ahead_in_imu_, force_};
  begin_ = has_bound_ ? end_ : bound;
  end_ = bound;
  force_.setZero();
  has_bound_ = waits_ = true;
}

/// The wheel's speed at its end is known by now, or will not be.
void AttitudeFilter::close_window(const Speed& speed) {
  waits_ = false;
  const std::optional<double> before = std::exchange(speed_, speed(end_.t_ns));
  if (begin_.t_ns == end_.t_ns) return;  // the first bound
  Eigen::Vector3d force = end_.force;
  if (before && speed_) force -= *speed_ * end_.ahead - *before * begin_.ahead;
  update(force / elapsed(begin_.t_ns, end_.t_ns), before && speed_ ? kWithWheel : kWithoutWheel);
}

/// @param gravity specific force of an IMU at rest, in level, m/s^2
/// @param deviation of its x and y, m/s^2
void AttitudeFilter::update(const Eigen::Vector3d& gravity, double deviation) {
  // A frame that is yet to be turned by t about x and y sees gravity at g (-t_y, t_x).
  Eigen::Matrix<double, 2, kStates> jacobian = Eigen::Matrix<double, 2, kStates>::Zero();
  jacobian(0, 1) = -kGravity;
  jacobian(1, 0) = kGravity;
  const Eigen::Matrix2d innovation_covariance = jacobian * covariance_ * jacobian.transpose() +
                                                deviation * deviation * Eigen::Matrix2d::Identity();
  const Eigen::Matrix<double, kStates, 2> gain =
      covariance_ * jacobian.transpose() * innovation_covariance.inverse();
  const States change = gain * gravity.head<2>();
  covariance_ -= (gain * jacobian * covariance_).eval();
  bias_ += change.tail<3>();
  lean({change[0], change[1], 0});
}

/// Corrects the frame in which all is kept.
void AttitudeFilter::lean(const Eigen::Vector3d& rotation) {
  const Eigen::Quaterniond turned = exponential(rotation);
  orientation_ = (turned * orientation_).normalized();
  end_.ahead = turned * end_.ahead;
  force_ = turned * force_;
}

}  // namespace scree
