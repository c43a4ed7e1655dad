#pragma once

#include <functional>

namespace scree {

/// The robot's GPIO lines, as far as they are wired.
struct RobotLines {
  /// Sets an output; false when that failed. Called from one thread.
  using Set = std::function<bool(bool is_on)>;

  Set stop;       ///< on: the robot must stop
  Set heartbeat;  ///< changes with each list that is published
};

}  // namespace scree
