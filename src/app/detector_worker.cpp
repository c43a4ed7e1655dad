#include "detector_worker.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace scree {
namespace {

using std::chrono::milliseconds;

// How often the sensors' rings are emptied without sweeps. They hold 4 s of samples, but a detector
// that has not looped for 250 ms counts as late (HealthWatch::kDetectorStops).
constexpr milliseconds kGatherInterval{20};
// How often a waiting sweep asks for samples: an MTi sends one every 10 ms.
constexpr milliseconds kMotionPause{1};

}  // namespace

DetectorWorker::DetectorWorker(SweepProcessor process, SyncBuffer* sensors, double max_wait_s,
                               SweepPool& sweeps, ObstacleListPool& lists)
    : process_(std::move(process)),
      sensors_(sensors),
      sweeps_(sweeps),
      waiting_(sweeps.fill().capacity),
      lists_(lists) {
  if (sensors_ != nullptr) wait_.emplace(*sensors_, max_wait_s);
}

void DetectorWorker::run() {
  while (!is_stopped_) {
    note_loop();
    sweeps_.wait(kGatherInterval);
    if (sensors_ != nullptr) sensors_->gather();
    bool was_full = false;
    while (TimedSweep* sweep = is_stopped_ ? nullptr : next_sweep(was_full)) {
      wait_for_motion(*sweep);
      process(*sweep);
      const QueueFill fill = sweeps_.fill();
      was_full = fill.waiting == fill.capacity;
      sweeps_.release(sweep);
      note_loop();
    }
  }
}

void DetectorWorker::stop() {
  is_stopped_ = true;
  sweeps_.wake();
}

void DetectorWorker::set_max_wait(double seconds) {
  if (wait_) wait_->set_limit(seconds);
}

/// The oldest that waits and is not left out; null when none waits.
/// @param was_full whether no sweep was free any more: a processor that is too slow must not make
/// every list late, so one of the turns that wait goes
TimedSweep* DetectorWorker::next_sweep(bool was_full) {
  while (TimedSweep* sweep = sweeps_.pop()) waiting_.push_back(sweep);
  if (waiting_.empty()) return nullptr;
  const TimedSweep* const newest = waiting_.back();
  const auto ends_turn = [](const TimedSweep* sweep) { return sweep->sweep.ends_turn; };
  bool has_too_many = was_full && std::ranges::count_if(waiting_, ends_turn) > 1;
  const auto is_left_out = [&](const TimedSweep* sweep) {
    return ends_turn(sweep) ? std::exchange(has_too_many, false) : sweep != newest;
  };
  std::size_t kept = 0;
  for (TimedSweep* sweep : waiting_) {
    if (is_left_out(sweep)) {
      skip(sweep);
    } else {
      waiting_[kept++] = sweep;
    }
  }
  TimedSweep* const next = waiting_[0];
  std::copy(waiting_.begin() + 1, waiting_.begin() + kept, waiting_.begin());
  waiting_.resize(kept - 1);
  return next;
}

void DetectorWorker::skip(TimedSweep* sweep) {
  auto& count = sweep->sweep.ends_turn ? sweeps_skipped_ : parts_skipped_;
  count.fetch_add(1, std::memory_order_relaxed);
  sweeps_.release(sweep);
}

void DetectorWorker::note_loop() {
  loops_.increment();
  last_loop_ns_.store(steady_ns(), std::memory_order_relaxed);
}

void DetectorWorker::wait_for_motion(const TimedSweep& sweep) {
  while (wait_ && !is_stopped_) {
    note_loop();
    if (wait_->is_over(sweep.sweep.end_ns, sweep.arrival_ns, steady_ns())) return;
    std::this_thread::sleep_for(kMotionPause);
  }
}

void DetectorWorker::process(const TimedSweep& sweep) {
  DetectionReport report;
  const std::int64_t begin_ns = steady_ns();
  const ObstacleList* list = process_(sweep.sweep, report);
  const std::int64_t end_ns = steady_ns();
  if (list == nullptr) return;
  TimedObstacleList* timed = lists_.acquire();
  if (timed == nullptr) {
    lists_dropped_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  timed->copy_from(*list, report);
  timed->arrival_ns = sweep.arrival_ns;
  timed->detector_ns = end_ns - begin_ns;
  lists_.push(timed);
}

}  // namespace scree
