#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "scree/app/robot_lines.hpp"
#include "scree/app/sweep_processor.hpp"
#include "scree/config/settings.hpp"
#include "scree/core/result.hpp"
#include "scree/sync/sync_buffer.hpp"

namespace scree {

/// The robot's daemon: one thread reads each sensor, one detects, one publishes lists and health
/// and writes the log. Between them lie bounded queues; where one is full the newest is dropped and
/// counted. A sensor that is lost is waited for, for ever. A sweep waits for the motion that covers
/// it, but not longer than map.wait.
///
/// Sweeps are on the monotonic clock, and so are the lists that `SweepProcessor` makes of them.
/// Lists are published in wall-clock time. Setting the wall clock disturbs nothing else.
class Daemon {
public:
  /// Binds the ports, opens LCM and starts the threads. The caller blocks the signals that it waits
  /// for before, because threads inherit what is blocked.
  /// @throw std::system_error where this process may have no more threads or descriptors
  /// @param sensors where samples of the motion go, its consumer the thread of `process`; without
  /// it neither IMU nor encoder are read
  static Result<std::unique_ptr<Daemon>> start(const Settings& settings, SweepProcessor process,
                                               SyncBuffer* sensors = nullptr,
                                               const RobotLines& lines = {});

  /// Stops and joins the threads. The stop line is set once more.
  virtual ~Daemon() = default;

  // For the thread that has started it.

  /// The name of a thread that has not looped since the last call that returned nothing; empty when
  /// all of them have. A thread that waits loops twice a second, the detector once a sweep.
  virtual std::string_view stalled_thread() = 0;
  /// Takes over settings.stop and settings.map.wait.
  virtual void apply(const Settings& settings) = 0;
  /// What the robot sees, or why it does not: one sentence.
  virtual std::string status() = 0;
};

}  // namespace scree
