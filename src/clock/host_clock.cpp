#include "scree/clock/host_clock.hpp"

#include <cstdlib>

namespace scree {

void HostClock::look(const ClockReading& now) {
  const std::int64_t difference = now.real_ns - now.monotonic_ns;
  if (!has_looked_) {
    has_looked_ = true;
    first_ns_ = difference_ns_ = difference;
    return;
  }
  if (std::abs(difference - difference_ns_) <= kJitter + now.width_ns) return;
  before_ns_ = difference_ns_;
  difference_ns_ = difference;
  step_ns_ = now.monotonic_ns;
  ++steps_;
}

std::int64_t HostClock::to_monotonic(std::int64_t real_ns, const ClockReading& now) {
  look(now);
  std::int64_t best = now.monotonic_ns, least_age = kOldest;
  const auto consider = [&](std::int64_t difference) {
    // Negative by no more than the jitter: of this very moment.
    const std::int64_t age = now.monotonic_ns - (real_ns - difference);
    if (age < -kJitter - now.width_ns || age >= least_age) return;
    least_age = age;
    best = real_ns - difference;
  };
  consider(difference_ns_);
  if (steps_ > 0 && now.monotonic_ns - step_ns_ < kLongestWait) consider(before_ns_);
  return best;
}

std::int64_t HostClock::to_first_real(std::int64_t real_ns, const ClockReading& now) {
  const std::int64_t monotonic_ns = to_monotonic(real_ns, now);
  // As long as nobody has set the clock a stamp stays as it is, however long it waited.
  return steps_ == 0 ? real_ns : monotonic_ns + first_ns_;
}

std::int64_t HostClock::to_real(std::int64_t monotonic_ns, const ClockReading& now) {
  look(now);
  return monotonic_ns + difference_ns_;
}

}  // namespace scree
