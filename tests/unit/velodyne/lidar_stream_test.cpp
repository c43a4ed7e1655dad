#include "scree/drivers/velodyne/lidar_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scree/core/nanoseconds.hpp"
#include "turning_sensor.hpp"

namespace scree::velodyne {
namespace {

TEST(LidarStream, CutsATurnWhereTheAzimuthPasses) {
  for (const double rate : {5.0, 10.0, 20.0}) {
    for (const double cut : {0.0, 90.0, 359.99}) {
      for (const ReturnMode mode : {ReturnMode::strongest, ReturnMode::dual}) {
        LidarSettings settings;
        settings.cut_azimuth_deg = cut;
        TurningSensor sensor(settings);
        sensor.turns_per_second = rate;
        sensor.mode = mode;
        sensor.send_for(2.0);
        sensor.stream().flush();
        SCOPED_TRACE(testing::Message() << rate << " Hz, cut at " << cut);
        const auto turns = static_cast<std::size_t>(2 * rate);
        ASSERT_NEAR(static_cast<double>(sensor.seen.size()), static_cast<double>(turns), 1.1);
        for (std::size_t i = 1; i + 1 < sensor.seen.size(); ++i) {
          const Seen& sweep = sensor.seen[i];
          EXPECT_TRUE(sweep.is_whole);
          EXPECT_NEAR(static_cast<double>(sweep.end_ns - sweep.begin_ns), 1e9 / rate, 2e5);
          // All the shots of a turn; equal dual returns count once.
          EXPECT_NEAR(static_cast<double>(sweep.points), 16 / (55.296e-6 * rate), 40);
          EXPECT_NEAR(static_cast<double>(sweep.packets),
                      1e9 / rate / static_cast<double>(sensor.duration()), 2.1);
          const double ends_at = (static_cast<double>(i) + cut / 360.0) / rate;
          EXPECT_NEAR(static_cast<double>(sweep.end_ns - kEpoch - sensor.delay_ns) * 1e-9,
                      ends_at + (cut == 0.0 ? 1 / rate : 0.0), 3e-4);
        }
        EXPECT_FALSE(sensor.seen.front().is_whole);
        EXPECT_FALSE(sensor.seen.back().is_whole);
        EXPECT_EQ(sensor.counters().lost, 0U);
        EXPECT_EQ(sensor.counters().dropped, 0U);
      }
    }
  }
}

TEST(LidarStream, DifferentDualReturnsAreTwoPoints) {
  TurningSensor sensor;
  sensor.mode = ReturnMode::dual;
  PacketBuilder packet = sensor.packet();
  packet.shot(0, 2600, 30);
  packet.shot(1, 0, 0);
  sensor.send(packet);
  sensor.stream().flush();
  ASSERT_EQ(sensor.seen.size(), 1U);
  EXPECT_EQ(sensor.seen[0].points, 6U * 32 + 1);
}

TEST(LidarStream, ASensorThatStandsStillGivesSweepsByTime) {
  TurningSensor sensor;
  sensor.turns_per_second = 0;
  sensor.send_for(2.0);
  ASSERT_GE(sensor.seen.size(), 8U);
  for (const Seen& sweep : sensor.seen) {
    EXPECT_NEAR(static_cast<double>(sweep.end_ns - sweep.begin_ns), kLongestSweepNs, 1e5);
    EXPECT_FALSE(sweep.is_whole);
  }
  EXPECT_GE(sensor.counters().standing, 8U);
  EXPECT_EQ(sensor.counters().dropped, 0U);
}

TEST(LidarStream, AWaveringAzimuthAtTheCutMakesNoShreds) {
  TurningSensor sensor;
  sensor.turns_per_second = 0;
  sensor.send_wavering_at_zero(2000);
  EXPECT_LE(sensor.seen.size(), 140U);
}

TEST(LidarStream, KnowsHowLongThereHasBeenNoReturn) {
  TurningSensor sensor;
  sensor.send_for(0.5);
  EXPECT_LT(sensor.stream().without_return_ns(), kBlockNs);
  const std::int64_t begin = sensor.elapsed_ns();
  while (sensor.elapsed_ns() - begin < kSecond / 4) sensor.send(sensor.packet().all_shots(0, 0));
  EXPECT_NEAR(static_cast<double>(sensor.stream().without_return_ns()),
              static_cast<double>(sensor.elapsed_ns() - begin), 1e5);
  sensor.send();
  EXPECT_LT(sensor.stream().without_return_ns(), kBlockNs);
}

TEST(LidarStream, EmptyTurnsAreHandedOutToo) {
  TurningSensor sensor;
  for (int i = 0; i < 200; ++i) sensor.send(sensor.packet().all_shots(0, 0));
  ASSERT_GE(sensor.seen.size(), 2U);
  EXPECT_EQ(sensor.seen[1].points, 0U);
  EXPECT_GT(sensor.seen[1].end_ns, sensor.seen[0].end_ns);
}

TEST(LidarStream, SaysHowWellItsClockIsKnown) {
  TurningSensor sensor;
  EXPECT_EQ(sensor.stream().clock().state(), ClockState::unsynchronised);
  sensor.send_for(1.5);
  EXPECT_EQ(sensor.stream().clock().state(), ClockState::estimated);
  for (int second = 1; second < 5; ++second) {
    sensor.stream().pps(kEpoch + second * kSecond);
    sensor.send_for(1.0);
  }
  EXPECT_EQ(sensor.stream().clock().state(), ClockState::pps_locked);
  EXPECT_LT(sensor.stream().clock().accuracy_ns(), 1000);
  const std::int64_t late_by =
      sensor.stream().clock().status().offset_ns - (kEpoch - 100 * kSecond);
  EXPECT_NEAR(static_cast<double>(late_by % kHourNs), 0, 1000) << "there is no delay in it";
}

TEST(LidarStream, ASweepMayBeSwappedAway) {
  Sweep mine(kSweepCapacity);
  std::size_t most = 0;
  LidarStream stream({}, [&](Sweep& sweep) {
    std::swap(mine, sweep);
    most = std::max(most, mine.points.size());
  });
  TurningSensor sensor;
  for (int i = 0; i < 400; ++i, sensor.skip()) {
    stream.take(sensor.packet().bytes(), kEpoch + sensor.elapsed_ns());
  }
  EXPECT_GT(most, 28000U);
  EXPECT_LT(most, 29500U);
}

TEST(LidarStream, NamesTheLaserOfEachPoint) {
  for (const ReturnMode mode : {ReturnMode::strongest, ReturnMode::dual}) {
    std::size_t points = 0;
    LidarStream stream({}, [&](Sweep& sweep) {
      ASSERT_EQ(sweep.laser.size(), sweep.points.size());
      points += sweep.points.size();
      for (std::size_t i = 0; i < sweep.points.size(); ++i) {
        const float up =
            std::atan2(sweep.points.z[i], std::hypot(sweep.points.x[i], sweep.points.y[i]));
        const int laser = sweep.laser[i];
        const int up_deg = laser % 2 == 0 ? laser - 15 : laser;  // 63-9243 Rev. D, table 9-1
        ASSERT_NEAR(up * 180 / std::numbers::pi, up_deg, 0.2);
      }
    });
    TurningSensor sensor;
    sensor.mode = mode;
    for (int i = 0; i < 400; ++i, sensor.skip()) {
      stream.take(sensor.packet().bytes(), kEpoch + sensor.elapsed_ns());
    }
    EXPECT_GT(points, 28000U);
  }
}

TEST(LidarStream, HandsOutTheShotsWithoutReturn) {
  for (const ReturnMode mode : {ReturnMode::strongest, ReturnMode::dual}) {
    int sweeps = 0;
    LidarStream stream({}, [&](Sweep& sweep) {
      if (!sweep.is_whole) return;
      ++sweeps;
      // 16 lasers a firing of 55.296 us; every fourth has no return.
      ASSERT_NEAR(static_cast<double>(sweep.points.size()), 0.75 * 28935, 60);
      ASSERT_NEAR(static_cast<double>(sweep.empty.size()), 0.25 * 28935, 60);
      std::int32_t before_ns = sweep.time_ns[0] - 1'000'000;
      for (const EmptyShot& shot : sweep.empty) {
        ASSERT_NEAR(shot.end.norm(), kNoReturnRange, 0.1);
        ASSERT_GE(shot.time_ns, before_ns);
        ASSERT_LT(shot.time_ns, 1'000'000);
        before_ns = shot.time_ns;
      }
    });
    TurningSensor sensor;
    sensor.mode = mode;
    for (int i = 0; i < 600; ++i, sensor.skip()) {
      PacketBuilder packet = sensor.packet();
      for (std::size_t shot = 0; shot < kShots; ++shot) {
        if (laser_of(shot) % 4 == 0) packet.shot(shot, 0, 0);
      }
      stream.take(packet.bytes(), kEpoch + sensor.elapsed_ns());
    }
    EXPECT_GE(sweeps, 2);
  }
}

}  // namespace
}  // namespace scree::velodyne
