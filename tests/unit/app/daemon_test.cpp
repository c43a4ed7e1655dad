#include "scree/app/daemon.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "scree/publish/subscriber.hpp"
#include "unit/app/sending_lidar.hpp"
#include "unit/free_port.hpp"

namespace scree {
namespace {

using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;

template <class AClock>
std::int64_t nanoseconds_of() {
  return std::chrono::nanoseconds(AClock::now().time_since_epoch()).count();
}

using Names = std::vector<std::string>;

template <class Named>
Names names_of(const std::vector<Named>& all) {
  Names names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

/// What comes on LCM.
class Listener {
public:
  explicit Listener(const std::string& url) {
    auto opened = Subscriber::open(
        url,
        [this](const obstacle_list_t& message) {
          list = message;
          ++lists;
        },
        [this](const health_t& message) {
          health = message;
          ++healths;
        });
    EXPECT_TRUE(opened) << opened.error().message;
    subscriber_ = std::move(*opened);
  }
  /// Receives until the condition holds; false after a minute.
  template <class Condition>
  bool until(Condition condition) {
    const auto end = Clock::now() + std::chrono::minutes(1);
    while (!condition()) {
      if (Clock::now() > end) return false;
      subscriber_->handle(1000);
    }
    return true;
  }

  int lists = 0, healths = 0;
  obstacle_list_t list{};
  health_t health{};

private:
  std::unique_ptr<Subscriber> subscriber_;
};

class DaemonTest : public ::testing::Test {
protected:
  DaemonTest() {
    settings_.lidar.address = "127.0.0.1";
    settings_.lidar.port = free_port();
    settings_.lidar.position_port = free_port();
    settings_.lcm.url = free_lcm_url();
    listener_.emplace(settings_.lcm.url);
  }
  /// Stands for the detector: an obstacle in each sweep.
  const ObstacleList* process(const Sweep& sweep, DetectionReport& report) {
    while (is_stuck_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    found_.stamp_ns = sweep.end_ns;
    sweep_age_ns_ = nanoseconds_of<Clock>() - sweep.end_ns;
    oldest_sweep_ns_ = std::max(oldest_sweep_ns_.load(), sweep_age_ns_.load());
    found_.obstacles.clear();
    Obstacle rock;
    rock.center.x() = rock_x_;
    rock.points = static_cast<std::uint32_t>(sweep.points.size());
    found_.obstacles.push_back(rock);
    report.drops = {1, 2, 3, 4, 5, 6};
    report.motion = {0.5, 0.25, 7, 8};
    report.stage_times.fill(kDidNotRun);
    report.stage_times[static_cast<std::size_t>(Stage::gradient)] = 7'000'000;
    return looks_ ? &found_ : nullptr;
  }
  std::unique_ptr<Daemon> start(SyncBuffer* sensors = nullptr) {
    auto daemon = Daemon::start(
        settings_,
        [this](const Sweep& sweep, DetectionReport& report) { return process(sweep, report); },
        sensors, lines_);
    EXPECT_TRUE(daemon) << daemon.error().message;
    return std::move(*daemon);
  }

  Settings settings_;
  std::optional<Listener> listener_;
  std::atomic<bool> is_stuck_ = false, looks_ = true;
  std::atomic<std::int64_t> sweep_age_ns_ = 0, oldest_sweep_ns_ = 0;
  std::atomic<double> rock_x_ = 100;
  RobotLines lines_;
  ObstacleList found_{1};
};

TEST_F(DaemonTest, ListsAndHealthComeAndBlindnessIsSaid) {
  const auto daemon = start();
  ASSERT_TRUE(listener_->until([&] { return listener_->healths > 0; }));
  EXPECT_EQ(listener_->health.state, health_t::BLIND);
  EXPECT_EQ(listener_->health.lidar.state, sensor_health_t::NEVER_SEEN);
  EXPECT_EQ(listener_->lists, 0);
  {
    const SendingLidar lidar(settings_.lidar.port);
    ASSERT_TRUE(listener_->until([&] {
      return listener_->lists > 2 && listener_->health.state == health_t::OK &&
             listener_->health.lists_published > 2 && listener_->health.lidar.rate > 0;
    }));
    // Inside runs the monotonic clock, what goes out has the time of the wall clock.
    constexpr double kMinute = 60e9;
    EXPECT_NEAR(static_cast<double>(sweep_age_ns_), 0, kMinute);
    EXPECT_NEAR(
        static_cast<double>(nanoseconds_of<std::chrono::system_clock>() - listener_->list.stamp_ns),
        0, kMinute);
    ASSERT_EQ(listener_->list.size, 1);
    EXPECT_GT(listener_->list.obstacles[0].points, 10000);
    EXPECT_EQ(listener_->health.lidar.source, "127.0.0.1");
    EXPECT_GT(listener_->health.lidar.expected_rate, 0);
    EXPECT_GT(listener_->health.latency.max_ms, 0);
    EXPECT_EQ(listener_->health.points_dropped, 1);
    EXPECT_EQ(listener_->health.edge_points_dropped, 2);
    EXPECT_EQ(listener_->health.obstacles_dropped, 3);
    EXPECT_EQ(listener_->health.map_points_dropped, 4);
    EXPECT_EQ(listener_->health.tracks_dropped, 5);
    EXPECT_EQ(listener_->health.points_refused, 6);
    EXPECT_EQ(listener_->health.position_deviation, 0.5);
    EXPECT_EQ(listener_->health.yaw_deviation, 0.25);
    EXPECT_EQ(listener_->health.sweeps_slipped, 7);
    EXPECT_EQ(listener_->health.heading_resets, 8);
    ASSERT_EQ(listener_->health.stages_size, 1);
    EXPECT_EQ(listener_->health.stages[0].name, "gradient");
    EXPECT_EQ(listener_->health.stages[0].time.max_ms, 7);
    EXPECT_EQ(names_of(listener_->health.queues), (Names{"sweeps", "lists"}));
    EXPECT_EQ(names_of(listener_->health.threads), (Names{"lidar", "detector", "publisher"}));
  }
  ASSERT_TRUE(
      listener_->until([&] { return listener_->health.lidar.state == sensor_health_t::SILENT; }));
  EXPECT_EQ(listener_->health.state, health_t::BLIND);
  EXPECT_THAT(listener_->health.reason, HasSubstr("no packets"));
  const int lists = listener_->lists, healths = listener_->healths;
  ASSERT_TRUE(listener_->until([&] { return listener_->healths > healths; }));
  EXPECT_EQ(listener_->lists, lists) << "no list is published by a blind robot";
}

TEST_F(DaemonTest, ASlowDetectorLosesTheNewestSweepsAndTheyAreCounted) {
  is_stuck_ = true;
  const auto daemon = start();
  const SendingLidar lidar(settings_.lidar.port);
  EXPECT_TRUE(listener_->until([&] { return listener_->health.sweeps_dropped > 0; }));
  EXPECT_EQ(listener_->lists, 0);
  EXPECT_EQ(listener_->health.state, health_t::BLIND);
  EXPECT_THAT(listener_->health.reason, HasSubstr("detector"));
  EXPECT_EQ(listener_->health.queues[0].waiting, 3);
  EXPECT_EQ(listener_->health.queues[0].capacity, 3);
  is_stuck_ = false;
  EXPECT_TRUE(listener_->until([&] { return listener_->health.state == health_t::OK; }));
}

TEST_F(DaemonTest, ASweepWaitsForMotionOnlySoLongAndSaysThatItWentOnWithoutIt) {
  settings_.imu.device = "/dev/scree-has-no-imu";
  settings_.encoder.interface = "no-can";
  SyncBuffer sensors;
  const auto daemon = start(&sensors);
  const SendingLidar lidar(settings_.lidar.port);
  constexpr std::int64_t kLateNs = 80'000'000;  // more than map.wait, and not yet silent
  const std::jthread imu([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      ImuSample sample;
      sample.has_orientation = true;
      sample.t_ns = nanoseconds_of<Clock>() - kLateNs;
      sensors.put(sample);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  ASSERT_TRUE(listener_->until(
      [&] { return listener_->health.sweeps_not_covered > 0 && listener_->lists > 2; }));
  EXPECT_GE(oldest_sweep_ns_, static_cast<std::int64_t>(settings_.map.wait * 1e9));
}

TEST_F(DaemonTest, NothingIsPublishedWhileNothingIsLookedAt) {
  looks_ = false;
  const auto daemon = start();
  const SendingLidar lidar(settings_.lidar.port);
  ASSERT_TRUE(listener_->until([&] { return listener_->health.sweeps > 5; }));
  EXPECT_EQ(listener_->lists, 0);
  EXPECT_EQ(listener_->health.state, health_t::BLIND);
  looks_ = true;
  EXPECT_TRUE(listener_->until([&] { return listener_->health.state == health_t::OK; }));
  EXPECT_GT(listener_->lists, 0);
}

TEST_F(DaemonTest, TheLinesFollowWhatIsSeen) {
  std::atomic<bool> is_stopped = false, cannot_stop = false;
  std::atomic<int> beats = 0;
  lines_.stop = [&](bool is_on) {
    if (!cannot_stop) is_stopped = is_on;
    return !cannot_stop;
  };
  lines_.heartbeat = [&](bool) {
    ++beats;
    return true;
  };
  settings_.stop.hold = 0.1;
  auto daemon = start();
  const auto says = [&](std::int8_t state, bool is_on) {
    return listener_->until([&] {
      const health_t& health = listener_->health;
      return health.state == state && health.stop == (is_on ? 1 : 0) && is_stopped == is_on;
    });
  };
  ASSERT_TRUE(says(health_t::BLIND, true));
  {
    const SendingLidar lidar(settings_.lidar.port);
    ASSERT_TRUE(says(health_t::OK, false));
    rock_x_ = 1;
    ASSERT_TRUE(says(health_t::OK, true));
    EXPECT_GT(beats, 0);
    rock_x_ = 100;
    ASSERT_TRUE(says(health_t::OK, false));
    cannot_stop = true;
  }
  ASSERT_TRUE(listener_->until([&] { return !listener_->health.lines_problem.empty(); }));
  EXPECT_THAT(listener_->health.lines_problem, HasSubstr("the stop line cannot be set"));
  cannot_stop = false;
  ASSERT_TRUE(listener_->until([&] { return listener_->health.lines_problem.empty(); }));
  {
    const SendingLidar lidar(settings_.lidar.port);
    ASSERT_TRUE(says(health_t::OK, false));
    daemon.reset();
  }
  EXPECT_TRUE(is_stopped) << "at the end";
}

TEST_F(DaemonTest, AThreadThatHangsIsNamed) {
  const auto daemon = start();
  // Asks from time to time, until it says so or a minute is over.
  const auto is_missing = [&](std::string_view thread) {
    const auto end = Clock::now() + std::chrono::minutes(1);
    while (daemon->stalled_thread() != thread && Clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return Clock::now() < end;
  };
  const SendingLidar lidar(settings_.lidar.port);
  ASSERT_TRUE(listener_->until([&] { return listener_->lists > 0; }));
  EXPECT_TRUE(is_missing(""));
  is_stuck_ = true;
  for (int i = 0; i < 3; ++i) {
    // All others loop meanwhile.
    std::this_thread::sleep_for(std::chrono::seconds(1));
    ASSERT_TRUE(is_missing("detector"));
  }
  is_stuck_ = false;
  EXPECT_TRUE(is_missing(""));
}

TEST_F(DaemonTest, TheStopZoneCanChangeMeanwhile) {
  settings_.stop.hold = 0;
  const auto daemon = start();
  const SendingLidar lidar(settings_.lidar.port);
  rock_x_ = 10;
  ASSERT_TRUE(listener_->until(
      [&] { return listener_->health.state == health_t::OK && listener_->health.stop == 0; }));
  EXPECT_EQ(daemon->status(), "sees");
  settings_.stop.length = 20;
  daemon->apply(settings_);
  ASSERT_TRUE(listener_->until([&] { return listener_->health.stop == 1; }));
  EXPECT_EQ(daemon->status(), "sees, and says stop");
}

TEST_F(DaemonTest, TheLastHealthSaysThatItWasStopped) {
  start().reset();
  EXPECT_TRUE(listener_->until([&] { return listener_->health.reason == "screed was stopped"; }));
}

TEST_F(DaemonTest, APortInUseIsOneSentence) {
  const auto first = start();
  const auto second = Daemon::start(settings_, {});
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message, HasSubstr(std::to_string(settings_.lidar.port)));
  EXPECT_THAT(second.error().message, HasSubstr("in use"));
}

}  // namespace
}  // namespace scree
