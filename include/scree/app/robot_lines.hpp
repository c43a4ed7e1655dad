#pragma once

#include <cstdint>
#include <functional>
#include <optional>

namespace scree {

/// The robot's GPIO lines, as far as they are wired.
struct RobotLines {
  /// Sets an output; false when that failed. Called from one thread.
  using Set = std::function<bool(bool is_on)>;

  /// A pulse per second. Used by one thread.
  struct Pulses {
    int descriptor = -1;  ///< readable while a pulse waits
    /// Wall-clock time of the next pulse that waits, or nothing. Never blocks.
    std::function<std::optional<std::int64_t>()> read;
  };

  Set stop;       ///< on: the robot must stop
  Set heartbeat;  ///< changes with each list that is published
  Pulses pps;     ///< that the lidar's clock is locked to
};

}  // namespace scree
