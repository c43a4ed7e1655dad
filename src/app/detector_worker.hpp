#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "loop_counter.hpp"
#include "scree/app/motion_wait.hpp"
#include "scree/app/sweep_processor.hpp"
#include "scree/clock/clocks.hpp"
#include "timed_obstacle_list.hpp"
#include "timed_sweep.hpp"

namespace scree {

/// Takes sweeps from their pool, lets each wait for the motion that covers it, has it processed and
/// passes the list on. When all sweeps of the pool are taken it is too slow: then the oldest turn
/// that waits is left out. A part of a turn is left out as soon as something newer waits, which
/// holds it too. run() is the work of a thread.
class DetectorWorker {
public:
  /// Keeps references to the buffer and to both pools.
  /// @param sensors without them sweeps wait for nothing
  DetectorWorker(SweepProcessor process, SyncBuffer* sensors, double max_wait_s, SweepPool& sweeps,
                 ObstacleListPool& lists);

  /// Returns after stop() was called from another thread.
  void run();
  void stop();

  // Any thread.

  /// How long a sweep waits at most for the motion that covers it, seconds.
  void set_max_wait(double seconds);
  const LoopCounter& loops() const { return loops_; }
  /// Monotonic time at which the worker last waited, or began or ended with a sweep.
  std::int64_t last_loop_ns() const { return last_loop_ns_.load(std::memory_order_relaxed); }
  /// Sweeps that waited in vain for the motion that covers them.
  std::uint64_t not_covered() const { return wait_ ? wait_->not_covered() : 0; }
  /// Lists that found the publisher busy with all older ones.
  std::uint64_t lists_dropped() const { return lists_dropped_.load(std::memory_order_relaxed); }

  /// Sweeps that were left out because newer ones waited.
  std::uint64_t sweeps_skipped() const { return sweeps_skipped_.load(std::memory_order_relaxed); }
  /// The same of parts of turns.
  std::uint64_t parts_skipped() const { return parts_skipped_.load(std::memory_order_relaxed); }

private:
  TimedSweep* next_sweep(bool was_full);
  void skip(TimedSweep* sweep);
  void note_loop();
  void wait_for_motion(const TimedSweep& sweep);
  void process(const TimedSweep& sweep);

  SweepProcessor process_;
  SyncBuffer* sensors_;
  std::optional<MotionWait> wait_;
  SweepPool& sweeps_;
  FixedVector<TimedSweep*> waiting_;  // taken from there, oldest first
  ObstacleListPool& lists_;
  LoopCounter loops_;
  std::atomic<bool> is_stopped_{false};
  std::atomic<std::int64_t> last_loop_ns_{steady_ns()};
  std::atomic<std::uint64_t> lists_dropped_{0}, sweeps_skipped_{0}, parts_skipped_{0};
};

}  // namespace scree
