#pragma once

#include <atomic>
#include <cstdint>

namespace scree {

/// A thread that waits for something goes round at least this often all the same.
constexpr int kLongestTurnMs = 500;

/// Counts how often a thread has gone round, so that another one can see whether it still does.
class Turns {
public:
  void note() { count_.fetch_add(1, std::memory_order_relaxed); }
  std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }

private:
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace scree
