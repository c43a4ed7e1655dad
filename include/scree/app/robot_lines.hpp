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
    /// Readable while a pulse waits; -1: the line is not there, and is looked for anew with each
    /// call. Without the function there is no such line.
    std::function<int()> descriptor;
    /// Wall-clock time of the next pulse that waits, or nothing. Never blocks.
    std::function<std::optional<std::int64_t>()> read;
    /// Lets go of a line whose chip is gone.
    std::function<void()> close;
  };

  Set stop;       ///< on: the robot must stop
  Set heartbeat;  ///< changes with each list that is published
  Pulses pps;     ///< that the lidar's clock is locked to
};

}  // namespace scree
