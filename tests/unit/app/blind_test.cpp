// When the robot is said to be blind, to the millisecond.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "app/health_watch.hpp"
#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

/// A robot whose lidar turns evenly, looked at every 20 ms as the daemon does. What is no longer
/// `true` has stopped.
struct Robot {
  explicit Robot(std::int64_t milliseconds_a_turn)
      : turn_ms(milliseconds_a_turn), most_latency_ms(std::min<std::int64_t>(90, turn_ms - 5)) {}

  void go_on(std::int64_t milliseconds) {
    for (std::int64_t i = 0; i < milliseconds; ++i) {
      now_ns += kMillisecond;
      if (has_packets) send();
      if (detector_works) detect();
      if (now_ns / kMillisecond % 20 == 0) {
        watch.update(now_ns, lidar, {}, {}, detector, health);
        was_blind_again = was_blind_again || (has_seen && is_blind());
        has_seen = has_seen || !is_blind();
      }
    }
  }
  void send() {
    lidar.last_datagram_ns = now_ns;
    if (is_understood) lidar.last_packet_ns = now_ns;
    lidar.without_return_ns = has_returns ? 0 : lidar.without_return_ns + kMillisecond;
    if (turns && now_ns / kMillisecond % turn_ms == 0) lidar.last_sweep_ns = now_ns;
  }
  /// The sweep's list comes after a latency that changes from sweep to sweep.
  void detect() {
    if (listed_sweep_ns == lidar.last_sweep_ns) {
      detector.last_loop_ns = now_ns;
    } else if (now_ns - lidar.last_sweep_ns >= latency_ms * kMillisecond) {
      detector.last_loop_ns = now_ns;
      listed_sweep_ns = lidar.last_sweep_ns;
      if (lists_go_out) detector.last_list_ns = listed_sweep_ns;
      latency_ms = least_latency_ms + (latency_ms + 37) % (most_latency_ms - least_latency_ms);
    }
  }
  bool is_blind() const { return health.state == health_t::BLIND; }

  std::int64_t turn_ms, least_latency_ms = 10, most_latency_ms, latency_ms = 10;
  bool has_packets = true, has_returns = true, turns = true, detector_works = true,
       lists_go_out = true, is_understood = true;
  bool has_seen = false, was_blind_again = false;
  std::int64_t now_ns = 5'000 * kMillisecond, listed_sweep_ns = 0;
  LidarStatus lidar;
  DetectorStatus detector{now_ns, 0};
  health_t health{};
  HealthWatch watch{Settings(), now_ns};
};

/// The longest time until it is said, of stops at all times of a turn.
struct Said {
  std::int64_t after_ms = 0;
  std::string reason;
};
Said when_stops(bool Robot::*what, std::int64_t turn_ms) {
  Said said;
  for (std::int64_t at_ms = 0; at_ms < turn_ms; at_ms += 7) {
    Robot robot(turn_ms);
    robot.go_on(2000 + at_ms);
    EXPECT_TRUE(robot.has_seen);
    EXPECT_FALSE(robot.was_blind_again);
    robot.*what = false;
    std::int64_t passed_ms = 0;
    for (; !robot.is_blind() && passed_ms < 2000; ++passed_ms) robot.go_on(1);
    said = {std::max(said.after_ms, passed_ms), robot.health.reason};
  }
  return said;
}

TEST(Blind, WhateverStopsIsSaidWithin300Ms) {
  for (const std::int64_t turn_ms : {50, 100, 200}) {
    const Said packets = when_stops(&Robot::has_packets, turn_ms);
    EXPECT_LE(packets.after_ms, 300);
    EXPECT_THAT(packets.reason, HasSubstr("no packets on UDP port 2368"));
    const Said understood = when_stops(&Robot::is_understood, turn_ms);
    EXPECT_LE(understood.after_ms, 300);
    EXPECT_THAT(understood.reason, HasSubstr("are not packets of a vlp16"));
    const Said returns = when_stops(&Robot::has_returns, turn_ms);
    EXPECT_LE(returns.after_ms, 300);
    EXPECT_THAT(returns.reason, HasSubstr("is it covered"));
    const Said turns = when_stops(&Robot::turns, turn_ms);
    EXPECT_LE(turns.after_ms, 300);
    EXPECT_THAT(turns.reason, HasSubstr("does it turn"));
    const Said detector = when_stops(&Robot::detector_works, turn_ms);
    EXPECT_LE(detector.after_ms, 300);
    EXPECT_THAT(detector.reason,
                AnyOf(HasSubstr("the detector is late"), HasSubstr("no list of the last half")));
  }
}

TEST(Blind, ListsThatDoNotGoOutAreSaidThoughAllElseWorks) {
  const Said said = when_stops(&Robot::lists_go_out, 100);
  EXPECT_LE(said.after_ms, 520);
  EXPECT_THAT(said.reason, HasSubstr("no list of the last half second has gone out"));
}

TEST(Blind, FromTheStartOn) {
  Robot robot(100);
  robot.has_packets = robot.detector_works = false;
  for (int i = 0; i < 500; ++i) {
    robot.go_on(20);
    EXPECT_TRUE(robot.is_blind());
  }
  EXPECT_THAT(robot.health.reason, HasSubstr("nothing has come"));
}

TEST(Blind, AfterAPauseWithTheFirstLook) {
  Robot robot(100);
  robot.go_on(1000);
  EXPECT_FALSE(robot.is_blind());
  // What waited meanwhile is of then, and so are the lists that are made of it.
  robot.now_ns += 4 * kSecond;
  robot.watch.update(robot.now_ns, robot.lidar, {}, {}, robot.detector, robot.health);
  EXPECT_TRUE(robot.is_blind());
  robot.lidar.last_datagram_ns = robot.lidar.last_packet_ns = robot.lidar.last_sweep_ns =
      robot.detector.last_loop_ns = robot.now_ns;
  robot.watch.update(robot.now_ns, robot.lidar, {}, {}, robot.detector, robot.health);
  EXPECT_TRUE(robot.is_blind());
  EXPECT_THAT(robot.health.reason, HasSubstr("no list of the last half second"));
  robot.go_on(200);
  EXPECT_FALSE(robot.is_blind());
}

TEST(Blind, ASettingThatSpoilsTheListsIsSaidWithTheNextLook) {
  Robot robot(100);
  robot.go_on(1000);
  robot.detector.setup.count = 1;
  robot.detector.setup.findings[0] = {
      .fault = SetupFault::encoder_scale, .is_grave = true, .off = 2, .set = {0.0001, 0, 0}};
  robot.go_on(20);
  EXPECT_TRUE(robot.is_blind());
}

TEST(Blind, ASlowTurnWithUnequalLatenciesIsNot) {
  Robot robot(200);
  robot.most_latency_ms = 195;
  robot.go_on(60'000);
  EXPECT_TRUE(robot.has_seen);
  EXPECT_FALSE(robot.was_blind_again);
}

TEST(Blind, SeesAgainOnlyOnceAListHasCome) {
  Robot robot(100);
  robot.go_on(1000);
  robot.has_packets = false;
  robot.go_on(5000);
  EXPECT_TRUE(robot.is_blind());
  robot.has_packets = true;
  const std::int64_t last_list_ns = robot.detector.last_list_ns;
  while (robot.detector.last_list_ns == last_list_ns) {
    EXPECT_TRUE(robot.is_blind());
    robot.go_on(1);
  }
  robot.go_on(20);
  EXPECT_FALSE(robot.is_blind());
}

}  // namespace
}  // namespace scree
