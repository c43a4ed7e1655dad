#include "app/detector_worker.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

constexpr std::size_t kSweeps = 3, kLists = 2;
// A sweep that ends shortly after the last sample: the next one is worth waiting for.
constexpr std::int64_t kSampleNs = 1'000 * kSecond, kEndNs = kSampleNs + 10 * kMillisecond;

class DetectorWorkerTest : public testing::Test {
protected:
  ~DetectorWorkerTest() override {
    if (!worker_) return;
    worker_->stop();
    thread_.join();
  }

  void start(SyncBuffer* sensors = nullptr, double max_wait_s = 0.05) {
    worker_.emplace(
        [this](const Sweep& sweep, DetectionReport& report) { return process(sweep, report); },
        sensors, max_wait_s, sweeps_, lists_);
    thread_ = std::thread([this] { worker_->run(); });
  }
  /// Stands for the detector: no obstacle in each sweep.
  const ObstacleList* process(const Sweep& sweep, DetectionReport& report) {
    processed_ns_ = steady_ns();
    list_.stamp_ns = sweep.end_ns;
    report.drops.points = 7;
    if (has_grid_) report.grid = &found_grid_;
    ++processed_;
    while (is_held_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return has_looked_ ? &list_ : nullptr;
  }
  /// Pushes a sweep that arrives now. @return its time of arrival
  std::int64_t push_sweep(std::int64_t end_ns = 0, bool ends_turn = true) {
    TimedSweep* item = nullptr;
    EXPECT_TRUE(until([&] { return (item = sweeps_.acquire()) != nullptr; }));
    const std::int64_t now_ns = steady_ns();
    item->sweep.end_ns = end_ns;
    item->sweep.ends_turn = ends_turn;
    item->arrival_ns = now_ns;
    sweeps_.push(item);
    return now_ns;
  }
  static ImuSample imu_sample(std::int64_t t_ns) {
    ImuSample sample;
    sample.has_orientation = true;
    sample.t_ns = t_ns;
    return sample;
  }
  /// Asks every millisecond until it holds; false after a minute.
  static bool until(const std::function<bool()>& holds) {
    for (int i = 0; i < 60'000; ++i) {
      if (holds()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  TimedObstacleList* next_list() {
    TimedObstacleList* list = nullptr;
    EXPECT_TRUE(until([&] { return (list = lists_.pop()) != nullptr; }));
    return list;
  }

  /// @param stamps of the lists that come next
  void expect_lists(std::initializer_list<std::int64_t> stamps) {
    for (const std::int64_t stamp_ns : stamps) {
      TimedObstacleList* timed = next_list();
      ASSERT_NE(timed, nullptr);
      EXPECT_EQ(timed->list.stamp_ns, stamp_ns);
      lists_.release(timed);
    }
  }

  SweepPool sweeps_{kSweeps, [] { return TimedSweep(); }};
  ObstacleListPool lists_{kLists, [] { return TimedObstacleList(1); }};
  ObstacleList list_{1};
  ObstacleGrid found_grid_;
  std::atomic<bool> has_grid_ = false, is_held_ = false;
  std::atomic<bool> has_looked_ = true;
  std::atomic<int> processed_ = 0;
  std::atomic<std::int64_t> processed_ns_ = 0;
  SyncBuffer sensors_;
  std::optional<DetectorWorker> worker_;
  std::thread thread_;
};

TEST_F(DetectorWorkerTest, PassesOnTheListWithItsTimesAndReport) {
  start();
  const std::int64_t arrival_ns = push_sweep(kEndNs);
  TimedObstacleList* timed = next_list();
  ASSERT_NE(timed, nullptr);
  EXPECT_EQ(timed->list.stamp_ns, kEndNs);
  EXPECT_EQ(timed->arrival_ns, arrival_ns);
  EXPECT_GE(timed->detector_ns, 0);
  EXPECT_EQ(timed->report.drops.points, 7U);
  EXPECT_EQ(worker_->not_covered(), 0U);
}

TEST_F(DetectorWorkerTest, PassesOnTheGridWithItsListAndNoOldOne) {
  found_grid_.columns = found_grid_.rows = 2;
  found_grid_.state.assign(4, CellState::free);
  found_grid_.ground.assign(4, 17);
  has_grid_ = true;
  start();
  for (std::size_t i = 0; i < kLists + 1; ++i) {
    push_sweep(kEndNs);
    TimedObstacleList* timed = next_list();
    ASSERT_NE(timed, nullptr);
    EXPECT_EQ(timed->grid.cells(), i < kLists ? 4U : 0U);
    EXPECT_EQ(timed->grid.state.size(), timed->grid.cells());
    EXPECT_EQ(timed->report.grid, nullptr);
    lists_.release(timed);
    if (i + 1 == kLists) has_grid_ = false;
  }
}

TEST_F(DetectorWorkerTest, ASweepThatWasNotLookedAtGivesNoList) {
  has_looked_ = false;
  start();
  push_sweep();
  ASSERT_TRUE(until([&] { return processed_ == 1; }));
  has_looked_ = true;
  const std::int64_t second_ns = push_sweep();
  TimedObstacleList* timed = next_list();
  ASSERT_NE(timed, nullptr);
  EXPECT_EQ(timed->arrival_ns, second_ns);
}

TEST_F(DetectorWorkerTest, ListsThatThePublisherDoesNotTakeAreDroppedAndCounted) {
  start();
  for (std::size_t i = 0; i < kLists + 2; ++i) {
    push_sweep();
    ASSERT_TRUE(until([&] { return sweeps_.fill().waiting == 0; }));
  }
  EXPECT_TRUE(until([&] { return worker_->lists_dropped() == 2; }));
}

TEST_F(DetectorWorkerTest, ASlowDetectorLeavesOutTheOldestSweepThatWaits) {
  is_held_ = true;
  start();
  push_sweep(kEndNs);
  ASSERT_TRUE(until([&] { return processed_ == 1; }));
  push_sweep(kEndNs + 1);
  push_sweep(kEndNs + 2);
  EXPECT_EQ(sweeps_.acquire(), nullptr);
  is_held_ = false;
  expect_lists({kEndNs, kEndNs + 2});
  EXPECT_EQ(worker_->sweeps_skipped(), 1U);
}

TEST_F(DetectorWorkerTest, APartOfATurnIsLeftOutWhereSomethingNewerWaits) {
  is_held_ = true;
  start();
  push_sweep(kEndNs, false);
  ASSERT_TRUE(until([&] { return processed_ == 1; }));
  push_sweep(kEndNs + 1, false);
  push_sweep(kEndNs + 2);
  is_held_ = false;
  expect_lists({kEndNs, kEndNs + 2});
  EXPECT_EQ(worker_->parts_skipped(), 1U);
  EXPECT_EQ(worker_->sweeps_skipped(), 0U);
}

TEST_F(DetectorWorkerTest, ASweepWaitsForMotionUntilTheLimit) {
  sensors_.put(imu_sample(kSampleNs));
  start(&sensors_, 0.08);
  const std::int64_t arrival_ns = push_sweep(kEndNs);
  ASSERT_NE(next_list(), nullptr);
  EXPECT_GE(processed_ns_ - arrival_ns, 80 * kMillisecond);
  EXPECT_EQ(worker_->not_covered(), 1U);
}

TEST_F(DetectorWorkerTest, ASweepGoesOnWithTheSampleThatCoversIt) {
  sensors_.put(imu_sample(kSampleNs));
  start(&sensors_, 60);
  push_sweep(kEndNs);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(processed_, 0);
  sensors_.put(imu_sample(kEndNs));
  ASSERT_NE(next_list(), nullptr);
  EXPECT_EQ(worker_->not_covered(), 0U);
}

TEST_F(DetectorWorkerTest, LoopsWithoutSweepsAndEmptiesTheRings) {
  start(&sensors_);
  sensors_.put(imu_sample(kSampleNs));
  EXPECT_TRUE(until([&] { return sensors_.imu_fill().waiting == 0; }));
  const std::uint64_t loops = worker_->loops().count();
  const std::int64_t loop_ns = worker_->last_loop_ns();
  EXPECT_TRUE(until([&] { return worker_->loops().count() > loops; }));
  EXPECT_TRUE(until([&] { return worker_->last_loop_ns() > loop_ns; }));
}

TEST_F(DetectorWorkerTest, StopsInTheMiddleOfAWait) {
  sensors_.put(imu_sample(kSampleNs));
  start(&sensors_, 3600);
  push_sweep(kEndNs);
}

}  // namespace
}  // namespace scree
