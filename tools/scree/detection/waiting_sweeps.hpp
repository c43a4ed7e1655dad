#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <utility>

#include "scree/app/motion_wait.hpp"
#include "scree/core/sweep.hpp"

namespace scree::cli {

/// Sweeps that wait for the IMU and encoder samples that cover them, as in the daemon, by the time
/// of the capture.
class WaitingSweeps {
public:
  /// Keeps a reference to the buffer.
  WaitingSweeps(double wait_s, SyncBuffer& sensors, std::function<void(const Sweep&)> process)
      : wait_(sensors, wait_s), process_(std::move(process)) {}

  void push(const Sweep& sweep, std::int64_t arrival_ns) {
    waiting_.emplace_back(copy(sweep), arrival_ns);
    process_ready(arrival_ns);
  }
  bool has_any() const { return !waiting_.empty(); }
  /// Processes those that are covered, or have waited long enough.
  void process_ready(std::int64_t now_ns) {
    while (!waiting_.empty()) {
      const auto& [sweep, arrival_ns] = waiting_.front();
      if (!wait_.is_over(sweep.end_ns, arrival_ns, now_ns)) return;
      process_(sweep);
      waiting_.pop_front();
    }
  }
  /// At the end of the capture, after which no sample comes.
  void process_all() {
    for (; !waiting_.empty(); waiting_.pop_front()) process_(waiting_.front().first);
  }
  /// Sweeps that waited in vain.
  std::uint64_t not_covered() const { return wait_.not_covered(); }

private:
  static Sweep copy(const Sweep& sweep) {
    Sweep copied(std::max(sweep.points.size(), sweep.empty.size()));
    copied.copy_from(sweep);
    return copied;
  }

  MotionWait wait_;
  std::function<void(const Sweep&)> process_;
  std::deque<std::pair<Sweep, std::int64_t>> waiting_;  // with their arrival
};

}  // namespace scree::cli
