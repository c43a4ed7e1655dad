#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <utility>

#include "scree/app/pipeline.hpp"

namespace scree::cli {

/// Sweeps that wait for the IMU and encoder samples that cover them, as in the daemon, by the time
/// of the capture.
class WaitingSweeps {
public:
  /// Keeps a reference to the pipeline.
  WaitingSweeps(double wait_s, Pipeline& pipeline, std::function<void(const Sweep&)> process)
      : wait_ns_(static_cast<std::int64_t>(wait_s * 1e9)),
        pipeline_(pipeline),
        process_(std::move(process)) {}

  void push(const Sweep& sweep, std::int64_t arrival_ns) {
    waiting_.emplace_back(copy(sweep), arrival_ns + wait_ns_);
    process_ready(arrival_ns);
  }
  bool has_any() const { return !waiting_.empty(); }
  /// Processes those that are covered, or have waited long enough.
  void process_ready(std::int64_t now_ns) {
    while (!waiting_.empty()) {
      const auto& [sweep, due_ns] = waiting_.front();
      const bool is_covered = pipeline_.is_covered(sweep.end_ns);
      if (now_ns < due_ns && !is_covered) return;
      if (!is_covered) ++not_covered_;
      process_(sweep);
      waiting_.pop_front();
    }
  }
  /// At the end of the capture, after which no sample comes.
  void process_all() {
    const std::size_t before = not_covered_;
    process_ready(INT64_MAX);
    not_covered_ = before;
  }
  /// Sweeps that waited in vain.
  std::size_t not_covered() const { return not_covered_; }

private:
  static Sweep copy(const Sweep& sweep) {
    Sweep copied(std::max(sweep.points.size(), sweep.empty.size()));
    for (std::size_t i = 0; i < sweep.points.size(); ++i) {
      copied.push_back({sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]},
                       sweep.points.reflectivity[i], sweep.time_ns[i], sweep.laser[i]);
    }
    for (const EmptyShot& shot : sweep.empty) copied.empty.push_back(shot);
    copied.end_ns = sweep.end_ns;
    copied.packets = sweep.packets;
    copied.dropped = sweep.dropped;
    copied.is_whole = sweep.is_whole;
    return copied;
  }

  std::int64_t wait_ns_;
  Pipeline& pipeline_;
  std::function<void(const Sweep&)> process_;
  std::deque<std::pair<Sweep, std::int64_t>> waiting_;
  std::size_t not_covered_ = 0;
};

}  // namespace scree::cli
