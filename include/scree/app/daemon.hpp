#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "scree/app/robot_lines.hpp"
#include "scree/config/settings.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/result.hpp"
#include "scree/core/stage_times.hpp"
#include "scree/core/sweep.hpp"
#include "scree/sync/sync_buffer.hpp"

namespace scree {

/// What did not fit in the memory of map, detector and tracker, since the start.
struct Dropped {
  std::uint64_t points = 0, edge_points = 0, obstacles = 0;  ///< detector
  std::uint64_t map_points = 0, tracks = 0;
  std::uint64_t points_refused = 0;  ///< by the detector: no numbers, or too far off
};

/// How well the robot's motion is known, and what was not believed of it since the start.
struct MotionReport {
  /// Standard deviations of the pose: the larger one of x and y, metres, and the yaw's, rad. No
  /// numbers where each sweep is taken by itself.
  double position_deviation = std::numeric_limits<double>::quiet_NaN();
  double yaw_deviation = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t slips = 0;           ///< sweeps during which the wheel slipped
  std::uint64_t heading_resets = 0;  ///< see HeadingWatch
};

/// What the detector reports of its work on one sweep.
struct Work {
  Dropped dropped;
  MotionReport motion;
  StageTimes stage_times{};
};

/// The detector's work on one sweep: the list is valid until the next call, and null when the sweep
/// was not looked at, so that nothing is known of what is there. Called from one thread.
using Process = std::function<const ObstacleList*(const Sweep& sweep, Work& work)>;

/// The robot's daemon: one thread reads each sensor, one detects, one publishes lists and health
/// and writes the log. Between them lie bounded rings; where one is full the newest is dropped and
/// counted. A sensor that is lost is waited for, for ever. A sweep waits for the motion that covers
/// it, but not longer than map.wait.
///
/// Sweeps are on the monotonic clock, and so are the lists that `Process` makes of them; lists are
/// published with the wall-clock time of then. Setting the wall clock disturbs nothing else.
class Daemon {
public:
  /// Binds the ports, opens LCM and starts the threads. The caller blocks the signals that it waits
  /// for before, because threads inherit what is blocked.
  /// @param sensors where samples of the motion go, its consumer the thread of Process; without it
  /// neither IMU nor encoder are read
  static Result<std::unique_ptr<Daemon>> start(const Settings& settings, Process process,
                                               SyncBuffer* sensors = nullptr,
                                               const RobotLines& lines = {});

  /// Stops and joins the threads. The stop line is set once more.
  virtual ~Daemon() = default;

  // For the thread that has started it.

  /// The name of a thread that has not looped since the last call that found that all had; empty
  /// when all have. A thread that waits loops twice a second, the detector once a sweep.
  virtual std::string_view stalled_thread() = 0;
  /// Takes over settings.stop and settings.map.wait.
  virtual void apply(const Settings& settings) = 0;
  /// What the robot sees, or why it does not; one sentence.
  virtual std::string status() = 0;
};

}  // namespace scree
