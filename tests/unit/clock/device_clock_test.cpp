#include "scree/clock/device_clock.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "clock_scenario.hpp"

namespace scree {
namespace {

using namespace clock_scenario;

constexpr std::int64_t kPacket = 1'327'104;

TEST(DeviceClock, FindsTheHostsTimeBehindDelaysAndSkew) {
  for (const double ppm : {-150.0, -20.0, 0.0, 20.0, 150.0}) {
    Scenario lidar;
    lidar.ppm = ppm;
    EXPECT_LT(lidar.run(60 * kSecond, kSecond / 10), 50'000) << ppm;
    EXPECT_EQ(lidar.jumps(), 0U);
  }
}

TEST(DeviceClock, IsEstimatedAfterEnoughPacketsOverEnoughTime) {
  Scenario lidar;
  EXPECT_EQ(lidar.clock.state(), ClockState::unsynchronised);
  lidar.run(kSecond - kPacket);
  EXPECT_EQ(lidar.clock.state(), ClockState::unsynchronised);
  EXPECT_GE(lidar.clock.accuracy_ns(), kMillisecond);
  lidar.run(3 * kPacket);
  EXPECT_EQ(lidar.clock.state(), ClockState::estimated);
  EXPECT_LT(lidar.clock.accuracy_ns(), kMillisecond);
  EXPECT_EQ(name_of(lidar.clock.state()), std::string("estimated"));

  Scenario rare;
  rare.sample_ns = kSecond;
  rare.run(19 * kSecond);
  EXPECT_EQ(rare.clock.state(), ClockState::unsynchronised);
}

TEST(DeviceClock, FirstPacketsThatAreLateAreMadeGoodWithoutRunningBackwards) {
  Scenario lidar;
  lidar.way = [](std::int64_t ready_ns, Random&) {
    return ready_ns + (ready_ns < kEpoch + 20 * kPacket ? 4 * kMillisecond : 0);
  };
  std::int64_t before = 0;
  for (int i = 0; i < 20; ++i) lidar.sample();
  EXPECT_EQ(lidar.error(), 4 * kMillisecond);
  for (int i = 0; i < 20; ++i) {
    lidar.sample();
    EXPECT_GT(lidar.host(), before);
    before = lidar.host();
  }
  EXPECT_LT(lidar.run(kSecond), 1000);
  EXPECT_EQ(lidar.jumps(), 0U);
}

TEST(DeviceClock, RunsOnAcrossTheWrapOfItsPeriod) {
  constexpr std::int64_t kSampleTimeFine = 4'294'967'296 * 100'000;  // of the Xsens
  for (const std::int64_t period : {kHour, kSampleTimeFine, 65'536 * 10 * kMillisecond}) {
    Scenario device(period);
    device.device_at_start_ns = period - 5 * kSecond;
    EXPECT_LT(device.run(10 * kSecond, kSecond / 10), 50'000);
    EXPECT_EQ(device.jumps(), 0U);
  }
}

TEST(DeviceClock, FindsTheHourAfterAGapOfAnyLength) {
  for (const std::int64_t gap :
       {2 * kSecond, 30 * kSecond, kHour / 2, kHour, 3 * kHour + 1700 * kSecond, 40 * 24 * kHour}) {
    Scenario lidar;
    lidar.device_at_start_ns = kHour - 5 * kSecond;
    lidar.ppm = 30;
    lidar.run(30 * kSecond);
    lidar.skip(gap);
    EXPECT_FALSE(lidar.sample()) << gap;
    EXPECT_LT(lidar.run(kSecond, kSecond / 10), 50'000) << gap;
    EXPECT_EQ(lidar.jumps(), 0U);
  }
}

TEST(DeviceClock, TheSkewBridgesTheTimeBetweenPromptPackets) {
  Scenario imu;
  imu.sample_ns = 10 * kMillisecond;
  imu.ppm = 100;
  imu.run(60 * kSecond);
  imu.way = [](std::int64_t ready_ns, Random&) { return ready_ns + 4 * kMillisecond; };
  EXPECT_LT(imu.run(20 * kSecond), 100'000) << "by the least delay alone it would be 2 ms";
}

TEST(DeviceClock, CountsARestartOfTheDevice) {
  Scenario lidar;
  lidar.run(2 * kSecond);
  lidar.device_at_start_ns = kHour - 2 * kSecond - 10 * kSecond;  // near its 0
  lidar.skip(8 * kSecond);
  bool told = false;
  for (int i = 0; i < 100 && !told; ++i) {
    told = lidar.sample();
    EXPECT_LT(std::abs(lidar.error()), 50 * kMillisecond) << "about the time of arrival";
  }
  EXPECT_TRUE(told);
  EXPECT_EQ(lidar.clock.device_restarts(), 1U);
  EXPECT_EQ(lidar.clock.host_steps(), 0U);
  EXPECT_EQ(lidar.clock.state(), ClockState::unsynchronised);
  EXPECT_LT(lidar.run(4 * kSecond, kSecond / 10), 50'000);
  EXPECT_EQ(lidar.clock.state(), ClockState::estimated);
}

TEST(DeviceClock, CountsStepsOfTheHostsClock) {
  for (const std::int64_t step :
       {-3600 * kSecond, -2 * kSecond, 5 * kSecond, 3600 * kSecond + 77}) {
    Scenario lidar;
    lidar.run(2 * kSecond);
    lidar.host_step_ns = step;
    lidar.run(2 * kSecond);
    // A whole hour forward cannot be told from a gap of as long, but the times come out right.
    EXPECT_EQ(lidar.clock.host_steps(), step < 3600 * kSecond ? 1U : 0U) << step;
    EXPECT_EQ(lidar.clock.device_restarts(), 0U);
    EXPECT_LT(lidar.run(kSecond), 50'000);
  }
}

TEST(DeviceClock, CountsASmallStepForwardAfterASecond) {
  for (const std::int64_t step : {8 * kMillisecond, 300 * kMillisecond}) {
    Scenario lidar;
    lidar.run(2 * kSecond);
    lidar.host_step_ns = step;
    lidar.run(3 * kSecond / 2);
    EXPECT_EQ(lidar.clock.host_steps(), 1U);
    EXPECT_LT(lidar.run(kSecond), 50'000) << step;
  }
}

TEST(DeviceClock, FollowsASmallStepBackwardsWithoutRunningBackwards) {
  Scenario lidar;
  lidar.run(30 * kSecond);
  lidar.host_step_ns = -10 * kMillisecond;
  std::int64_t before = lidar.host();
  for (int i = 0; i < 100; ++i) {
    lidar.sample();
    EXPECT_GT(lidar.host(), before);
    before = lidar.host();
  }
  EXPECT_LT(lidar.run(kSecond), 50'000);
  EXPECT_EQ(lidar.jumps(), 0U);
}

TEST(DeviceClock, AHostThatWasBusyIsNoStep) {
  Scenario lidar;
  lidar.way = [](std::int64_t ready_ns, Random&) {
    const bool is_busy = ready_ns / (kSecond / 2) % 2 == 0;  // half a second, all packets late
    return ready_ns + (is_busy ? 200 * kMillisecond : 0);
  };
  EXPECT_LT(lidar.run(5 * kSecond, 3 * kSecond / 2), 50'000);
  EXPECT_EQ(lidar.jumps(), 0U);
}

TEST(DeviceClock, WhatWaitedInABufferKeepsItsTimes) {
  for (const std::int64_t stall : {300 * kMillisecond, 1500 * kMillisecond}) {
    Scenario imu;
    imu.sample_ns = 10 * kMillisecond;
    imu.run(20 * kSecond);
    const std::int64_t until = imu.now() + stall;
    imu.way = [&](std::int64_t ready_ns, Random&) { return std::max(ready_ns, until); };
    EXPECT_LT(imu.run(5 * kSecond), 100'000);
    EXPECT_EQ(imu.jumps(), 0U);
  }
}

TEST(DeviceClock, GarbledStampsAreLeftOut) {
  Scenario imu(4'294'967'296 * 100'000);
  imu.sample_ns = 10 * kMillisecond;
  imu.run(10 * kSecond);
  std::uint64_t garbled = 0;
  for (int i = 0; i < 5000; ++i) {
    if (i % 50 == 7) {
      const auto by = static_cast<std::int64_t>(imu.random()()) * 100'000 + 2 * kSecond;
      EXPECT_FALSE(imu.sample(by));
      EXPECT_EQ(imu.error() + by, imu.delay() + by) << "it is given its time of arrival";
      ++garbled;
    } else if (i % 1500 == 3) {
      imu.sample(20 * kMillisecond);  // a few bits only
    } else {
      imu.sample();
      EXPECT_LT(std::abs(imu.error()), 50'000) << i;
    }
  }
  EXPECT_EQ(imu.clock.implausible(), garbled);
  EXPECT_EQ(imu.jumps(), 0U);
}

TEST(DeviceClock, ReorderedAndRepeatedStampsDoNoHarm) {
  Scenario lidar;
  lidar.run(5 * kSecond);
  for (int i = 0; i < 2000; ++i) {
    lidar.sample();
    const std::int64_t time = lidar.now() - kPacket, stamp = lidar.device(time);
    const std::int64_t arrival = time + lidar.least_delay_ns + lidar.delay();
    if (i % 3 == 0) {
      EXPECT_FALSE(lidar.clock.update(stamp, arrival + 1000));
    }
    if (i % 5 == 0) {
      const std::int64_t older = lidar.device(time - 7 * kPacket);
      EXPECT_FALSE(lidar.clock.update(older, arrival + 2000));
      EXPECT_NEAR(static_cast<double>(lidar.clock.to_host(older)),
                  static_cast<double>(lidar.host() - 7 * kPacket), 100);
    }
    ASSERT_LT(std::abs(lidar.error()), 50'000);
  }
  EXPECT_EQ(lidar.jumps(), 0U);
}

TEST(DeviceClock, AClockThatStoodStillIsFollowedOnceItRuns) {
  Scenario lidar;
  lidar.run(2 * kSecond);
  const std::int64_t stamp = lidar.device(lidar.now());
  for (int i = 0; i < 5000; ++i, lidar.skip(kPacket)) {
    lidar.clock.update(stamp, lidar.now());
    EXPECT_LE(lidar.clock.to_host(stamp), lidar.now() + kMillisecond);
  }
  EXPECT_LT(lidar.run(5 * kSecond, 2 * kSecond), 50'000);
}

TEST(DeviceClock, SurvivesAnyTimes) {
  std::mt19937_64 random(5);
  DeviceClock clock(kHour);
  for (int i = 0; i < 100'000; ++i) {
    const auto any = [&](std::int64_t below) {
      return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(below));
    };
    const std::int64_t device = any(kHour);
    clock.update(random() % 2 == 0 ? device : i * kMillisecond, kEpoch + any(1'000'000 * kSecond));
    if (i % 10 == 0) clock.pps(kEpoch + any(1'000'000 * kSecond));
    EXPECT_GE(clock.to_host(device), 0);
    EXPECT_GE(clock.accuracy_ns(), 0);
  }
}

}  // namespace
}  // namespace scree
