#include "scree/sync/device_clock.hpp"

#include <algorithm>

namespace scree {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000, kSecond = 1'000'000'000;

/// How far the clocks may run apart in a time: 200 ppm.
constexpr std::int64_t drift(std::int64_t elapsed_ns) {
  return elapsed_ns / 5000;
}

/// A packet this much before its time has been stamped by another clock than those before it ...
constexpr std::int64_t kTooEarly = 50 * kMillisecond;
/// ... and so has one this much after it, whatever delays a busy host may have.
constexpr std::int64_t kTooLate = kSecond;
/// A device whose clock went back by more than packets overtake each other has started over.
constexpr std::int64_t kBackwards = 50 * kMillisecond;
/// Smaller steps of the host's clock: every packet is late by this much ...
constexpr std::int64_t kLate = 20 * kMillisecond;
/// ... for this long.
constexpr std::int64_t kLateFor = kSecond;

}  // namespace

std::int64_t DeviceClock::wrapped(std::int64_t difference_ns) const {
  const std::int64_t rest = difference_ns % period_ns_;
  if (rest >= (period_ns_ + 1) / 2) return rest - period_ns_;
  if (rest < -period_ns_ / 2) return rest + period_ns_;
  return rest;
}

void DeviceClock::start_over(std::int64_t device_ns, std::int64_t arrival_ns) {
  started_ = true;
  device_ns_ = device_ns;
  arrival_ns_ = host_ns_ = arrival_ns;
  least_late_ns_ = 0;
}

bool DeviceClock::update(std::int64_t device_ns, std::int64_t arrival_ns) {
  if (!started_) {
    start_over(device_ns, arrival_ns);
    return true;
  }
  const std::int64_t host_elapsed = arrival_ns - arrival_ns_;
  // The device's clock tells how much time went by, but not how many of its periods; the host's
  // knows well enough.
  const std::int64_t remainder = wrapped(device_ns - device_ns_ - host_elapsed);
  const std::int64_t device_elapsed = host_elapsed + remainder;
  const std::int64_t leak = drift(std::max<std::int64_t>(host_elapsed, 0));
  const std::int64_t expected = host_ns_ + device_elapsed;
  const std::int64_t residual = arrival_ns - expected;

  const bool backwards = device_elapsed < -kBackwards;
  if (backwards || residual < -kTooEarly - leak || residual > kTooLate + leak) {
    const std::int64_t device_step = wrapped(device_ns - device_ns_);
    const bool device_steady = device_step >= 0 && device_step < kSecond;
    ++(device_steady ? host_steps_ : device_restarts_);
    start_over(device_ns, arrival_ns);
    return true;
  }
  if (residual > kLate) {
    if (least_late_ns_ == 0) late_since_ns_ = arrival_ns;
    least_late_ns_ = least_late_ns_ == 0 ? residual : std::min(least_late_ns_, residual);
    if (arrival_ns - late_since_ns_ > kLateFor) {
      ++host_steps_;
      const std::int64_t least = least_late_ns_;
      start_over(device_ns, arrival_ns);
      host_ns_ = expected + least;
      return true;
    }
  } else {
    least_late_ns_ = 0;
  }
  host_ns_ = std::min(expected + leak, arrival_ns);
  device_ns_ = device_ns;
  arrival_ns_ = arrival_ns;
  return false;
}

std::int64_t DeviceClock::to_host(std::int64_t device_ns) const {
  return host_ns_ + wrapped(device_ns - device_ns_);
}

std::int64_t DeviceClock::offset_ns() const {
  return wrapped(host_ns_ - device_ns_);
}

}  // namespace scree
