#pragma once

#include <cstdint>

#include "scree/core/nanoseconds.hpp"

namespace scree {

/// A packet's device time, which does not wrap, and by how much its arrival on the host's clock
/// exceeds it: the difference of the clocks plus the packet's delay.
struct ClockSample {
  std::int64_t device_ns = 0, offset_ns = 0;

  std::int64_t host_ns() const { return device_ns + offset_ns; }
};

/// What a skew makes of a time: `elapsed_ns * ppb / 1e9`. @pre |ppb| <= 1e6
constexpr std::int64_t gained_ns(std::int64_t elapsed_ns, std::int64_t ppb) {
  return elapsed_ns / kSecond * ppb + elapsed_ns % kSecond * ppb / kSecond;
}

/// The offset of the host's clock from a device's, as a line over device time.
struct ClockLine {
  std::int64_t device_ns = 0, offset_ns = 0;  ///< a point of it
  std::int64_t skew_ppb = 0;  ///< how much longer the host finds a second of the device, in 1e-9

  std::int64_t offset_at(std::int64_t at_device_ns) const {
    return offset_ns + gained_ns(at_device_ns - device_ns, skew_ppb);
  }
};

}  // namespace scree
