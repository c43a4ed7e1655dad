#include "detector_worker.hpp"

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
    : process_(std::move(process)), sensors_(sensors), sweeps_(sweeps), lists_(lists) {
  if (sensors_ != nullptr) wait_.emplace(*sensors_, max_wait_s);
}

void DetectorWorker::run() {
  while (!is_stopped_) {
    note_loop();
    sweeps_.wait(kGatherInterval);
    if (sensors_ != nullptr) sensors_->gather();
    while (TimedSweep* sweep = is_stopped_ ? nullptr : sweeps_.pop()) {
      wait_for_motion(*sweep);
      process(*sweep);
      const QueueFill fill = sweeps_.fill();
      sweeps_.release(sweep);
      if (fill.waiting == fill.capacity) skip_oldest();
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

/// A processor that is too slow must not make every list late.
void DetectorWorker::skip_oldest() {
  TimedSweep* const sweep = sweeps_.pop();
  if (sweep == nullptr) return;
  sweeps_.release(sweep);
  sweeps_skipped_.fetch_add(1, std::memory_order_relaxed);
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
