#pragma once

#include <atomic>
#include <cstdint>

#include "scree/sync/sync_buffer.hpp"

namespace scree {

/// Decides how long a sweep waits for the samples of IMU and encoder that cover it: until they have
/// come, but not longer than a limit. Times are of the clock that the samples are on. One thread
/// may use it, that which consumes the samples, but for what is said of any thread.
class MotionWait {
public:
  /// Keeps a reference to the buffer.
  MotionWait(SyncBuffer& sensors, double limit_s) : sensors_(sensors) { set_limit(limit_s); }

  /// Takes over the samples that have come. True when the sweep may go on: nothing is missing for
  /// it, or it has waited for the limit since it arrived. The latter is counted, so that a sweep is
  /// asked for only until this is true.
  bool is_over(std::int64_t end_ns, std::int64_t arrival_ns, std::int64_t now_ns) {
    sensors_.gather();
    if (sensors_.covers(end_ns)) return true;
    if (now_ns < arrival_ns + limit_ns_.load(std::memory_order_relaxed)) return false;
    not_covered_.fetch_add(1, std::memory_order_relaxed);
    return true;
  }

  /// Any thread: takes effect from the next question on.
  void set_limit(double limit_s) {
    limit_ns_.store(static_cast<std::int64_t>(limit_s * 1e9), std::memory_order_relaxed);
  }
  /// Any thread: how many sweeps have waited in vain.
  std::uint64_t not_covered() const { return not_covered_.load(std::memory_order_relaxed); }

private:
  SyncBuffer& sensors_;
  std::atomic<std::int64_t> limit_ns_{0};
  std::atomic<std::uint64_t> not_covered_{0};
};

}  // namespace scree
