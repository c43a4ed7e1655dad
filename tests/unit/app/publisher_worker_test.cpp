#include "app/publisher_worker.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "scree/clock/clocks.hpp"
#include "scree/publish/subscriber.hpp"
#include "unit/deaf_server.hpp"
#include "unit/free_port.hpp"

namespace scree {
namespace {

class PublisherWorkerTest : public testing::Test {
protected:
  explicit PublisherWorkerTest(const std::string& lcm_url = "") {
    const std::string url = free_lcm_url();
    auto subscriber = Subscriber::open(
        url,
        [this](const obstacle_list_t& message) {
          list_ = message;
          ++lists_received_;
        },
        [this](const health_t& message) { health_ = message; },
        [this](const grid_t& message) {
          lists_before_grid_ = lists_received_;
          grid_ = message;
        });
    auto publisher = Publisher::open(lcm_url.empty() ? url : lcm_url);
    EXPECT_TRUE(subscriber && publisher);
    subscriber_ = std::move(*subscriber);
    settings_.stop.hold = 0.01;
    lines_.stop = [this](bool is_on) {
      is_stopped_ = is_on;
      return true;
    };
    lines_.heartbeat = [this](bool) {
      ++heartbeats_;
      return true;
    };
    worker_.emplace(
        settings_, lines_, std::move(*publisher), lists_, [this] { return get_status(); },
        watchdog_);
    thread_ = std::thread([this] { worker_->run(); });
  }
  ~PublisherWorkerTest() override { stop(); }

  void stop() {
    worker_->stop();
    if (thread_.joinable()) thread_.join();
  }
  /// Stands for a lidar and a detector that work.
  DaemonStatus get_status() {
    const std::int64_t now_ns = steady_ns();
    DaemonStatus status;
    status.lidar.last_datagram_ns = status.lidar.last_packet_ns = status.lidar.last_sweep_ns =
        now_ns;
    status.detector_loop_ns = now_ns;
    status.lists_dropped = 3;
    status.samples_refused = 4;
    status.queues = {{"lists", lists_.fill()}};
    return status;
  }
  /// Pushes a list of a sweep that arrived some time ago.
  void push_list(std::int64_t age_ns, std::size_t grid_columns = 0) {
    TimedObstacleList* timed = lists_.acquire();
    ASSERT_NE(timed, nullptr);
    timed->grid.columns = timed->grid.rows = grid_columns;
    timed->grid.state.assign(timed->grid.cells(), CellState::free);
    timed->grid.ground.assign(timed->grid.cells(), 0);
    timed->arrival_ns = timed->list.stamp_ns = steady_ns() - age_ns;
    lists_.push(timed);
  }
  /// Receives until it holds; false after a minute.
  bool until(const std::function<bool()>& holds) {
    const std::int64_t end_ns = steady_ns() + 60 * kSecond;
    while (!holds() && steady_ns() < end_ns) subscriber_->handle(100);
    return holds();
  }

  Settings settings_;
  RobotLines lines_;
  ObstacleListPool lists_{4, [] { return TimedObstacleList(1); }};
  ThreadWatchdog watchdog_;
  std::atomic<int> heartbeats_ = 0;
  std::atomic<bool> is_stopped_ = true;  // as the chip is opened
  int lists_received_ = 0;
  obstacle_list_t list_{};
  grid_t grid_{};
  int lists_before_grid_ = 0;
  health_t health_{};
  std::unique_ptr<Subscriber> subscriber_;
  std::optional<PublisherWorker> worker_;
  std::thread thread_;
};

TEST_F(PublisherWorkerTest, AListGoesOutInWallClockTimeAndBeats) {
  push_list(0);
  ASSERT_TRUE(until([&] { return lists_received_ == 1; }));
  EXPECT_NEAR(static_cast<double>(wall_ns() - list_.stamp_ns), 0, 60e9);
  EXPECT_TRUE(until([&] { return heartbeats_ == 1; }));
  EXPECT_TRUE(until([&] { return health_.state == health_t::OK && health_.lists_published == 1; }));
}

TEST_F(PublisherWorkerTest, AGridGoesOutAfterItsListAndWithItsStamp) {
  push_list(0);
  push_list(0, 5);
  ASSERT_TRUE(until([&] { return grid_.cells == 25; }));
  EXPECT_EQ(lists_before_grid_, 2) << "the first list has none";
  EXPECT_EQ(grid_.stamp_ns, list_.stamp_ns);
  EXPECT_EQ(health_.lists_failed, 0);
}

TEST_F(PublisherWorkerTest, AnOldListGoesOutButIsNoSight) {
  push_list(HealthWatch::kOldData + kSecond);
  ASSERT_TRUE(until([&] { return lists_received_ == 1 && health_.lists_published == 1; }));
  EXPECT_EQ(health_.state, health_t::BLIND);
  EXPECT_EQ(health_.reason, "sweeps come, but no list of the last half second has gone out");
}

/// Its LCM server takes what fits into the sockets, and nothing after that.
class BlockedLcmTest : public PublisherWorkerTest {
protected:
  BlockedLcmTest() : BlockedLcmTest(std::make_unique<DeafServer>()) {}

private:
  explicit BlockedLcmTest(std::unique_ptr<DeafServer> server)
      : PublisherWorkerTest(server->url()), server_(std::move(server)) {}
  std::unique_ptr<DeafServer> server_;
};

TEST_F(BlockedLcmTest, TheStopLineComesOnAllTheSame) {
  const std::int64_t end_ns = steady_ns() + 120 * kSecond;
  bool has_seen = false;
  std::int64_t cleared_ns = steady_ns();
  // Lists with the largest grids fill the sockets up soon.
  while (steady_ns() < end_ns && !(has_seen && is_stopped_)) {
    if (lists_.fill().waiting < 4) push_list(0, ObstacleGrid::kMostCells);
    if (!is_stopped_) has_seen = true;
    if (!is_stopped_) cleared_ns = steady_ns();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(has_seen && is_stopped_);
  EXPECT_LT(steady_ns() - cleared_ns, kSecond) << "and the threads go on";
  EXPECT_TRUE(until([&] { return worker_->sentence().starts_with("blind"); }))
      << "the line goes first, then words";
}

TEST_F(PublisherWorkerTest, HealthHasTheCountsOfTheOtherThreads) {
  ASSERT_TRUE(until([&] { return health_.queues_size == 1; }));
  EXPECT_EQ(health_.lists_dropped, 3);
  EXPECT_EQ(health_.samples_refused, 4);
  EXPECT_EQ(health_.queues[0].name, "lists");
}

TEST_F(PublisherWorkerTest, AtItsEndTheRobotIsBlind) {
  push_list(0);
  ASSERT_TRUE(until([&] { return health_.state == health_t::OK; }));
  stop();
  EXPECT_TRUE(until([&] { return health_.state == health_t::BLIND; }));
  EXPECT_EQ(worker_->sentence(), "blind: screed was stopped");
}

}  // namespace
}  // namespace scree
