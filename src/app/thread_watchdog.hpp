#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "loop_counter.hpp"

namespace scree {

/// Finds the thread whose loop has stopped. One thread may use it.
class ThreadWatchdog {
public:
  /// Keeps references to both.
  void add(std::string_view thread, const LoopCounter& loops) {
    watched_.push_back({thread, &loops, loops.count()});
  }

  bool watches(std::string_view thread) const {
    return std::ranges::any_of(watched_, [&](const Watched& one) { return one.thread == thread; });
  }

  /// The first thread that has not looped since the last call that returned nothing; empty when all
  /// of them have.
  std::string_view stalled() {
    for (const Watched& watched : watched_) {
      if (watched.loops->count() == watched.last_count) return watched.thread;
    }
    for (Watched& watched : watched_) watched.last_count = watched.loops->count();
    return {};
  }

private:
  struct Watched {
    std::string_view thread;
    const LoopCounter* loops;
    std::uint64_t last_count;
  };
  std::vector<Watched> watched_;
};

}  // namespace scree
