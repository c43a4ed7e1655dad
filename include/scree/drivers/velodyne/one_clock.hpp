#pragma once

#include <cstdint>
#include <cstdlib>
#include <optional>

#include "scree/core/nanoseconds.hpp"
#include "scree/drivers/velodyne/data_packet.hpp"

namespace scree::velodyne {

/// Tells the packets of two sensors apart that send from one address, as two do that were never
/// given addresses of their own: their clocks run beside each other. A sensor that starts anew has
/// another clock too, but the old one never comes again.
class OneClock {
public:
  /// @param device_ns the packet's time stamp
  /// @return false for a packet of the second sensor
  bool takes(std::int64_t device_ns, std::int64_t arrival_ns) {
    const Reading now{device_ns, arrival_ns};
    if (!taken_ || fits(*taken_, now)) {
      taken_ = now;
      return true;
    }
    const bool is_alive = arrival_ns - taken_->arrival_ns < kSecond;
    if (has_second_ && is_alive) return false;
    const bool comes_again =
        before_ && arrival_ns - before_->arrival_ns < kBeside && fits(*before_, now);
    has_second_ = comes_again;
    before_ = taken_;
    taken_ = now;
    return true;
  }

private:
  static constexpr std::int64_t kApart = 50 * kMillisecond;
  // Both are heard within this: each sends a packet every 1.3 ms.
  static constexpr std::int64_t kBeside = 50 * kMillisecond;

  struct Reading {
    std::int64_t device_ns, arrival_ns;
  };
  static bool fits(const Reading& before, const Reading& now) {
    const std::int64_t apart =
        (now.device_ns - before.device_ns - (now.arrival_ns - before.arrival_ns)) % kHourNs;
    const std::int64_t off = std::abs(apart);
    return off < kApart || off > kHourNs - kApart;
  }

  std::optional<Reading> taken_, before_;
  bool has_second_ = false;
};

}  // namespace scree::velodyne
