#include "scree/motion/slip_watch.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "felt.hpp"

namespace scree {
namespace {

/// The mean over an interval; nothing where the wheel was silent.
std::optional<double> wheel_speed(const SyncBuffer& sensors, std::int64_t begin_ns,
                                  std::int64_t end_ns) {
  const auto begin = sensors.wheel_at(begin_ns), end = sensors.wheel_at(end_ns);
  if (!end) return std::nullopt;
  const double seconds = static_cast<double>(end_ns - begin_ns) * 1e-9;
  return begin ? (end->distance - begin->distance) / seconds : end->speed;
}

}  // namespace

void SlipWatch::advance(const SyncBuffer& sensors, std::int64_t begin_ns, std::int64_t end_ns,
                        double speed) {
  constexpr double kLongest = 0.5;  // seconds
  const double seconds = static_cast<double>(end_ns - begin_ns) * 1e-9;
  const bool is_short = seconds > 0 && seconds < kLongest;
  std::optional<double> faster, wheel;
  if (is_short) {
    faster = made_faster(sensors, begin_ns, end_ns, mount_, origin_);
    wheel = wheel_speed(sensors, begin_ns, end_ns);
  }
  if (!wheel || slips_) speed_ = speed;
  if (!faster) {
    slips_ = is_known_ = false;
    return;
  }
  speed_ = std::clamp(speed_ + *faster, -max_speed_, max_speed_);
  if (!wheel) {
    slips_ = false;
    return;
  }
  // The mean is that of the middle.
  const double wheel_now = *wheel + *faster / 2;
  if (is_known_) return judge(wheel_now, seconds);
  speed_ = wheel_now;
  is_known_ = true;
}

void SlipWatch::judge(double wheel, double seconds) {
  constexpr double kApart = 0.4, kApartShare = 0.1;  // m/s apart, and of the speed
  constexpr double kAgreement = 0.2;                 // m/s apart ...
  constexpr double kAgreedFor = 0.25;                // ... for so many seconds
  constexpr double kLongest = 4;   // seconds: what the IMU has summed up is no better then
  constexpr double kFollow = 0.5;  // seconds: the accelerometer's bias has no time to tell
  const double apart = wheel - speed_;
  if (!slips_) {
    slips_ = std::abs(apart) > kApart + kApartShare * std::abs(speed_);
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
