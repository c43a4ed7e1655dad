#pragma once

#include <cstdint>
#include <deque>
#include <string_view>

#include "loop_counter.hpp"
#include "page_faults.hpp"

namespace scree {

/// Finds the thread whose loop has stopped, and knows the page faults of all. One thread may use
/// it; page faults are for any, once all were added.
class ThreadWatchdog {
public:
  /// Keeps references to both.
  /// @return what the thread shall open, once it runs
  ThreadPageFaults& add(std::string_view thread, const LoopCounter& loops) {
    Watched& watched = watched_.emplace_back();
    watched.thread = thread;
    watched.loops = &loops;
    watched.last_count = loops.count();
    return watched.page_faults;
  }

  /// Calls visit(name, PageFaults) for each thread whose page faults are known.
  template <class Visit>
  void for_each_page_faults(const Visit& visit) const {
    for (const Watched& watched : watched_) {
      if (const auto faults = watched.page_faults.read()) visit(watched.thread, *faults);
    }
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
    const LoopCounter* loops = nullptr;
    std::uint64_t last_count = 0;
    ThreadPageFaults page_faults;
  };
  std::deque<Watched> watched_;  // they stay where they are
};

}  // namespace scree
