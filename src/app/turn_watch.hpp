#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "turns.hpp"

namespace scree {

/// Whether all of some threads go round. One thread may use it.
class TurnWatch {
public:
  /// Keeps references to both.
  void add(std::string_view thread, const Turns& turns) {
    watched_.push_back({thread, &turns, turns.count()});
  }

  bool watches(std::string_view thread) const {
    return std::ranges::any_of(watched_, [&](const Watched& one) { return one.thread == thread; });
  }

  /// The first thread that has not gone round since this last found that all had; empty when all
  /// have.
  std::string_view missing() {
    for (const Watched& watched : watched_) {
      if (watched.turns->count() == watched.seen) return watched.thread;
    }
    for (Watched& watched : watched_) watched.seen = watched.turns->count();
    return {};
  }

private:
  struct Watched {
    std::string_view thread;
    const Turns* turns;
    std::uint64_t seen;
  };
  std::vector<Watched> watched_;
};

}  // namespace scree
