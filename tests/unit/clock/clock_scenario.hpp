#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <random>

#include "scree/clock/device_clock.hpp"
#include "scree/core/nanoseconds.hpp"

namespace scree::clock_scenario {

inline constexpr std::int64_t kHour = 3600 * kSecond;
inline constexpr std::int64_t kEpoch = 1'598'612'523 * kSecond;

using Random = std::mt19937;
/// Time at which a sample that was ready at a time reaches the host; without the constant delay.
using Way = std::function<std::int64_t(std::int64_t ready_ns, Random& random)>;

inline std::int64_t exponential(double mean_ns, Random& random) {
  return static_cast<std::int64_t>(std::exponential_distribution<double>(1 / mean_ns)(random));
}

/// Mostly next to no delay, now and then a host that is busy for milliseconds.
inline std::int64_t network(std::int64_t ready_ns, Random& random) {
  return ready_ns + exponential(random() % 50 == 0 ? 3e6 : 50e3, random);
}

/// Every sample is late by 0 to 5 ms.
inline std::int64_t busy_host(std::int64_t ready_ns, Random& random) {
  return ready_ns + static_cast<std::int64_t>(random() % 5'000'000);
}

/// Seven seconds of ten next to no delay, then three in which everything is late by 1 to 5 ms.
inline std::int64_t busy_spells(std::int64_t ready_ns, Random& random) {
  const bool busy = ready_ns / kSecond % 10 >= 7;
  return ready_ns + (busy ? kMillisecond + exponential(2e6, random) : exponential(50e3, random));
}

/// One sample in a hundred is prompt, all others are late by 1 to 4 ms.
inline std::int64_t rarely_prompt(std::int64_t ready_ns, Random& random) {
  if (random() % 100 == 0) return ready_ns + exponential(5e3, random);
  return ready_ns + kMillisecond + static_cast<std::int64_t>(random() % 3'000'000);
}

/// A USB adapter that hands over what it has 16 ms after it did so before, or a little later.
class UsbAdapter {
public:
  std::int64_t operator()(std::int64_t ready_ns, Random& random) {
    while (next_ns_ < ready_ns) next_ns_ += 16 * kMillisecond + exponential(200e3, random);
    return next_ns_;
  }

private:
  std::int64_t next_ns_ = kEpoch;
};

/// A device whose clock runs fast by `ppm`, its way to the host, and what the clock makes of it.
class Scenario {
public:
  double ppm = 0;
  std::int64_t sample_ns = 1'327'104;  ///< between two samples, on the device's clock
  Way way = network;
  std::int64_t period_ns;
  std::int64_t device_at_start_ns = 100 * kSecond;
  std::int64_t least_delay_ns = 100'000;
  std::int64_t host_step_ns = 0;  ///< how far the host's clock was set since the start
  DeviceClock clock;

  explicit Scenario(std::int64_t period = kHour) : period_ns(period), clock(period) {}

  std::int64_t device(std::int64_t true_ns) const {
    const double gained = static_cast<double>(true_ns - kEpoch) * ppm * 1e-6;
    return (device_at_start_ns + true_ns - kEpoch + std::llround(gained)) % period_ns;
  }
  /// The present, true time: that of the next sample.
  std::int64_t now() const { return now_; }
  void skip(std::int64_t duration_ns) { now_ += duration_ns; }
  /// A sample, and what to_host() makes of its stamp; stamps may be garbled by an amount.
  bool sample(std::int64_t garbled_by_ns = 0) {
    arrival_ns_ = std::max(arrival_ns_, way(now_, random_) + least_delay_ns);
    stamp_ = ((device(now_) + garbled_by_ns) % period_ns + period_ns) % period_ns;
    const bool started_over = clock.update(stamp_, arrival_ns_ + host_step_ns);
    truth_ = now_ + garbled_by_ns + least_delay_ns + host_step_ns;
    now_ += sample_ns - static_cast<std::int64_t>(static_cast<double>(sample_ns) * ppm * 1e-6);
    return started_over;
  }
  /// What to_host() makes of the last sample's stamp, and how late that is.
  std::int64_t host() const { return clock.to_host(stamp_); }
  std::int64_t error() const { return host() - truth_; }
  /// How late the last sample came.
  std::int64_t delay() const { return arrival_ns_ + host_step_ns - truth_; }

  /// Samples for a time; the largest error among those after `settling_ns`.
  std::int64_t run(std::int64_t duration_ns, std::int64_t settling_ns = 0) {
    std::int64_t worst = 0;
    for (const std::int64_t begin = now_; now_ < begin + duration_ns;) {
      const bool settled = now_ >= begin + settling_ns;
      sample();
      if (settled) worst = std::max(worst, std::abs(error()));
    }
    return worst;
  }
  std::uint64_t jumps() const { return clock.device_restarts() + clock.host_steps(); }
  Random& random() { return random_; }

private:
  Random random_{7};
  std::int64_t now_ = kEpoch, arrival_ns_ = 0, truth_ = 0, stamp_ = 0;
};

}  // namespace scree::clock_scenario
