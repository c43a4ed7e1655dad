#pragma once

#include <atomic>
#include <cstdint>

namespace scree {

/// The longest that a thread waits for something before it runs through its loop again. It is less
/// than the 0.75 s between two checks of the watchdog, a quarter of the service's WatchdogSec.
constexpr int kMaxWaitMs = 500;

/// Counts how often a thread has run through its loop, for another thread that watches it.
class LoopCounter {
public:
  void increment() { count_.fetch_add(1, std::memory_order_relaxed); }
  std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }

private:
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace scree
