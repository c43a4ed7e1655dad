#pragma once

#include <cstdint>

#include "scree/clock/host_clock.hpp"
#include "scree/core/nanoseconds.hpp"

namespace scree {

/// The monotonic clock, on which everything runs: never set.
inline std::int64_t steady_ns() {
  return read_clock(CLOCK_MONOTONIC);
}

/// Nanoseconds since the UNIX epoch, as the kernel stamps datagrams: for the edges only.
inline std::int64_t wall_ns() {
  return read_clock(CLOCK_REALTIME);
}

/// Both, as close together as a thread that may be interrupted can read them.
inline ClockReading read_clocks() {
  constexpr std::int64_t kCloseEnough = 10'000;
  ClockReading best;
  for (int tries = 0; tries < 4; ++tries) {
    const std::int64_t before = steady_ns(), wall = wall_ns(), after = steady_ns();
    if (tries == 0 || after - before < best.width_ns) best = {after, wall, after - before};
    if (best.width_ns <= kCloseEnough) break;
  }
  return best;
}

}  // namespace scree
