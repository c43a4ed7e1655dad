#include "scree/motion/slip_detector.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scree/core/rotation.hpp"
#include "scree/motion/specific_force.hpp"

namespace scree {

/// The mean speed of `base` by the wheel over an interval; nothing where that was silent.
std::optional<double> SlipDetector::wheel_speed(const SyncBuffer& sensors, std::int64_t begin_ns,
                                                std::int64_t end_ns) const {
  const auto begin = sensors.wheel_at(begin_ns), end = sensors.wheel_at(end_ns);
  if (!end) return std::nullopt;
  const double seconds = static_cast<double>(end_ns - begin_ns) * 1e-9;
  const double rolled = begin ? (end->distance - begin->distance) / seconds : end->speed;
  const auto from = sensors.attitude_at(begin_ns), to = sensors.attitude_at(end_ns);
  if (!from || !to) return rolled;
  const Eigen::Vector3d turn = mount_ * logarithm(from->rotation.conjugate() * to->rotation);
  return rolled - turn.cross(wheel_place_).x() / seconds;
}

void SlipDetector::advance(const SyncBuffer& sensors, std::int64_t begin_ns, std::int64_t end_ns,
                           double speed) {
  constexpr double kLongest = 0.5;  // seconds
  const double seconds = static_cast<double>(end_ns - begin_ns) * 1e-9;
  const bool is_short = seconds > 0 && seconds < kLongest;
  std::optional<double> change, wheel;
  if (is_short) {
    change = forward_velocity_change(sensors, begin_ns, end_ns, mount_, origin_);
    wheel = wheel_speed(sensors, begin_ns, end_ns);
  }
  if (!wheel || slips_) speed_ = speed;
  if (!change) {
    slips_ = is_known_ = false;
    return;
  }
  speed_ = std::clamp(speed_ + *change, -max_speed_, max_speed_);
  if (!wheel) {
    slips_ = false;
    return;
  }
  // A mean speed is that of the interval's middle.
  const double wheel_now = *wheel + *change / 2;
  if (is_known_) return compare(wheel_now, seconds);
  speed_ = wheel_now;
  is_known_ = true;
}

void SlipDetector::compare(double wheel, double seconds) {
  // Chosen on simulated drives whose wheel spins 1 m/s too fast, or whose counter stands.
  constexpr double kSlip = 0.4, kSlipShare = 0.1;  // m/s apart, and share of the speed
  constexpr double kAgreement = 0.2;               // m/s apart ...
  constexpr double kAgreedFor = 0.25;              // ... for so many seconds: it grips again
  constexpr double kLongest = 4;   // seconds: after that the IMU's integral is no better
  constexpr double kFollow = 0.5;  // seconds: too short for the accelerometer's bias to add up
  const double apart = wheel - speed_;
  if (!slips_) {
    slips_ = std::abs(apart) > kSlip + kSlipShare * std::abs(speed_);
    agreed_s_ = slipped_s_ = 0;
  } else {
    slipped_s_ += seconds;
    agreed_s_ = std::abs(apart) < kAgreement ? agreed_s_ + seconds : 0;
    slips_ = agreed_s_ < kAgreedFor && slipped_s_ < kLongest;
    if (!slips_) speed_ = wheel;
  }
  if (!slips_) speed_ += (wheel - speed_) * std::min(seconds / kFollow, 1.0);
}

}  // namespace scree
