#include <gtest/gtest.h>

#include "clock_scenario.hpp"

namespace scree {
namespace {

using namespace clock_scenario;

/// A lidar whose clock follows GPS: whole seconds at the edges of its pulse, whose host times are a
/// little late.
class Locked : public Scenario {
public:
  std::int64_t edge_error_ns = 0;
  bool has_edges = true;

  Locked() { least_delay_ns = 3 * kMillisecond; }
  void run_with_edges(std::int64_t duration_ns) {
    for (const std::int64_t end = now() + duration_ns; now() < end;) {
      const std::int64_t second = device(now()) / kSecond;
      sample();
      if (has_edges && device(now()) / kSecond != second) clock.pps(edge());
    }
  }
  /// What to_host() is off by, without any delay in it.
  double error_us() const { return static_cast<double>(error() + least_delay_ns) * 1e-3; }
  void expect_locked(double expected_us) {
    EXPECT_EQ(clock.state(), ClockState::pps_locked);
    EXPECT_NEAR(error_us(), expected_us, 12);
  }

private:
  /// Host time of the edge at the beginning of the present device second.
  std::int64_t edge() {
    const std::int64_t since = device(now()) % kSecond;
    return now() - static_cast<std::int64_t>(static_cast<double>(since) * (1 - ppm * 1e-6)) +
           host_step_ns + edge_error_ns + static_cast<std::int64_t>(random()() % 10'000);
  }
};

TEST(Pps, TakesTheDelayOutOfTheTimes) {
  for (const double ppm : {-50.0, 0.0, 20.0}) {
    Locked lidar;
    lidar.ppm = ppm;
    lidar.run_with_edges(3 * kSecond / 2);
    EXPECT_EQ(lidar.clock.state(), ClockState::estimated);
    EXPECT_NEAR(lidar.error_us(), 3000, 100);
    lidar.run_with_edges(5 * kSecond);
    EXPECT_EQ(lidar.clock.state(), ClockState::pps_locked);
    for (int i = 0; i < 30; ++i) {
      lidar.run_with_edges(kSecond);
      EXPECT_NEAR(lidar.error_us(), 5, 12) << ppm << " ppm";
    }
    EXPECT_LT(lidar.clock.accuracy_ns(), 20'000);
    EXPECT_EQ(lidar.clock.edges_refused(), 0U);
  }
}

TEST(Pps, RunsOnAcrossTheFullHour) {
  Locked lidar;
  lidar.device_at_start_ns = kHour - 10 * kSecond;
  lidar.run_with_edges(20 * kSecond);
  lidar.expect_locked(5);
}

TEST(Pps, RefusesEdgesThatDoNotAgree) {
  Locked lidar;
  lidar.run_with_edges(10 * kSecond);
  for (const std::int64_t off : {400 * kMicrosecond, -2 * kMillisecond, 20 * kMillisecond}) {
    lidar.clock.pps(lidar.now() / kSecond * kSecond + off);
    lidar.run_with_edges(2 * kSecond);
    lidar.expect_locked(5);
  }
  EXPECT_EQ(lidar.clock.edges_refused(), 3U);
}

TEST(Pps, RefusesThePulseOfAnotherClock) {
  for (const std::int64_t off : {300, 25, -30}) {
    Locked lidar;
    lidar.edge_error_ns = off * kMillisecond;
    lidar.run_with_edges(20 * kSecond);
    EXPECT_EQ(lidar.clock.state(), ClockState::estimated) << off;
    EXPECT_NEAR(lidar.error_us(), 3000, 20);
    EXPECT_GE(lidar.clock.edges_refused(), 17U);
  }
}

TEST(Pps, FollowsAPulseThatMoved) {
  Locked lidar;
  lidar.run_with_edges(10 * kSecond);
  lidar.edge_error_ns = kMillisecond;
  lidar.run_with_edges(10 * kSecond);
  lidar.expect_locked(1005);
  EXPECT_EQ(lidar.clock.edges_refused(), 3U);
}

TEST(Pps, IsGivenUpSomeSecondsAfterTheLastEdge) {
  Locked lidar;
  lidar.run_with_edges(10 * kSecond);
  lidar.has_edges = false;
  lidar.run_with_edges(3 * kSecond);
  EXPECT_EQ(lidar.clock.state(), ClockState::pps_locked);
  EXPECT_NEAR(lidar.error_us(), 5, 20);
  const std::int64_t before = lidar.host();
  lidar.run_with_edges(3 * kSecond);
  EXPECT_EQ(lidar.clock.state(), ClockState::estimated);
  EXPECT_NEAR(lidar.error_us(), 3000, 100);
  EXPECT_GT(lidar.host(), before);
  lidar.has_edges = true;
  lidar.run_with_edges(5 * kSecond);
  EXPECT_EQ(lidar.clock.state(), ClockState::pps_locked);
}

TEST(Pps, TimesNeverRunBackwardsWhenItIsGainedAndLost) {
  Locked lidar;
  std::int64_t before = 0;
  for (int i = 0; i < 30'000; ++i) {
    lidar.has_edges = i % 10'000 < 5'000;
    lidar.run_with_edges(1);
    ASSERT_GE(lidar.host(), before);
    before = lidar.host();
  }
}

TEST(Pps, CountsForNothingOnAClockWithoutWholeSeconds) {
  DeviceClock clock(4'294'967'296 * 100'000);
  for (std::int64_t t = 0; t < 10 * kSecond; t += 10 * kMillisecond) {
    clock.update(t, kEpoch + t);
    if (t % kSecond == 0) clock.pps(kEpoch + t);
  }
  EXPECT_EQ(clock.state(), ClockState::estimated);
}

TEST(Pps, EdgesBeforeAnyPacketAreHarmless) {
  DeviceClock clock(kHour);
  for (int i = 0; i < 5; ++i) clock.pps(kEpoch + i * kSecond);
  EXPECT_EQ(clock.state(), ClockState::unsynchronised);
}

}  // namespace
}  // namespace scree
