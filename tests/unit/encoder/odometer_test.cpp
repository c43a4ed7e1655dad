#include "scree/drivers/encoder/odometer.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "scree/core/nanoseconds.hpp"
#include "wheel.hpp"

namespace scree::encoder {
namespace {

EncoderSettings counter(int length = 32, double scale = 0.000157, bool is_signed = true) {
  EncoderSettings settings;
  settings.length = length;
  settings.scale = scale;
  settings.is_signed = is_signed;
  return settings;
}

EncoderSettings speed_signal(double scale = 0.001) {
  EncoderSettings settings = counter(16, scale);
  settings.kind = EncoderKind::speed;
  return settings;
}

TEST(Odometer, CountsThroughWraps) {
  for (const bool is_signed : {true, false}) {
    Wheel wheel(counter(16, 0.000157, is_signed));
    wheel.first_count = 30'000;
    EXPECT_EQ(wheel.roll(20, 1, 1), 0);
    EXPECT_NEAR(wheel.odometer.distance(), 20 - 0.01, 0.0003);  // since the first frame
    EXPECT_EQ(wheel.roll(40, -1, -1), 0);
    EXPECT_NEAR(wheel.odometer.distance(), -20 - 0.01, 0.0003);
    EXPECT_EQ(wheel.odometer.rebased(), 0U);
  }
}

TEST(Odometer, AScaleBelowZeroTurnsTheWay) {
  Wheel wheel(counter(32, -0.000157));
  EXPECT_EQ(wheel.roll(2, 0.5, 0.5), 0);
  EXPECT_NEAR(wheel.odometer.distance(), 1 - 0.005, 0.0003);
}

/// Interval (ms), scale (m), in bursts.
class Driving : public testing::TestWithParam<std::tuple<int, double, bool>> {};

TEST_P(Driving, NothingOfARealDriveIsRefused) {
  const auto [interval, scale, is_in_bursts] = GetParam();
  Wheel wheel(counter(32, scale), interval * kMillisecond);
  wheel.is_in_bursts = is_in_bursts;
  wheel.send(wheel.raw());
  int refused = wheel.roll(1, 0, 0);
  for (const double speed : {0.05, 0.4, 1.1, 2.2, 4.6}) {
    refused += wheel.roll(speed / 8, 0, speed);  // m/s^2
    refused += wheel.roll(1.7, speed, speed);
    refused += wheel.roll(speed / 9.5, speed, 0);
    refused += wheel.roll(0.6, 0, 0);
    refused += wheel.roll(speed / 4, 0, -speed);
    refused += wheel.roll(1.3, -speed, -0.8 * speed);
    refused += wheel.roll(speed / 9.5, -0.8 * speed, 0);
  }
  EXPECT_EQ(refused, 0);
  EXPECT_EQ(wheel.odometer.rebased(), 0U);
  EXPECT_NEAR(wheel.odometer.distance(), wheel.way, scale + 1e-9);
}

INSTANTIATE_TEST_SUITE_P(All, Driving,
                         testing::Combine(testing::Values(5, 10, 20, 50, 100),
                                          testing::Values(0.000157, 0.001, 0.05), testing::Bool()));

TEST(Odometer, AGarbledReadingIsRefusedAndTheNextGoesOn) {
  Wheel wheel(counter());
  wheel.roll(1, 1, 1);
  for (const unsigned bit : {11U, 13U, 20U, 30U}) {
    const double before = wheel.odometer.distance();
    wheel.t_ns += 5 * kMillisecond;
    EXPECT_EQ(wheel.send(wheel.raw() ^ (std::int64_t{1} << bit)), Refusal::implausible) << bit;
    EXPECT_EQ(wheel.odometer.distance(), before);
    wheel.t_ns -= 5 * kMillisecond;
    EXPECT_EQ(wheel.roll(0.1, 1, 1), 0);
  }
  EXPECT_NEAR(wheel.odometer.distance(), wheel.way - 0.01, 0.0003);
  EXPECT_EQ(wheel.odometer.rebased(), 0U);
}

// A wheel may be so fast, with frames so late, but it does not become so from one to the next.
TEST(Odometer, AnImpossibleAccelerationIsRefused) {
  Wheel wheel(counter());
  wheel.roll(1, 1, 1);
  wheel.t_ns += 5 * kMillisecond;
  constexpr std::int64_t kJump = 850;  // counts, 0.13 m
  EXPECT_EQ(wheel.send(wheel.raw() + kJump), Refusal::implausible);
  wheel.t_ns -= 5 * kMillisecond;
  EXPECT_EQ(wheel.roll(1, 1, 1), 0);
}

TEST(Odometer, ARestartedCounterDoesNotMakeTheDistanceJump) {
  for (const int interval : {5, 10, 50, 100}) {
    Wheel wheel(counter(), interval * kMillisecond);
    wheel.first_count = 1'000'000;
    wheel.roll(3, 1, 1);
    wheel.first_count = -static_cast<std::int64_t>(wheel.way / 0.000157);
    const int refused = wheel.roll(1, 1, 1);
    EXPECT_EQ(wheel.odometer.rebased(), 1U);
    EXPECT_LE(refused, interval < 15 ? 10 : 3) << interval;
    // The way before the first frame, and that of the frame of the jump, are not known.
    EXPECT_NEAR(wheel.odometer.distance(), 4 - 0.002 * interval, 0.0006) << interval;
  }
}

TEST(Odometer, WhatNoWheelDoesIsRefusedForAsLongAsItGoesOn) {
  Wheel wheel(counter());
  EXPECT_EQ(wheel.roll(1, 0, 4), 0);
  wheel.roll(2, 30, 30);
  EXPECT_GT(wheel.seen[Refusal::implausible], 190);
  EXPECT_LT(wheel.odometer.distance(), 3);
}

TEST(Odometer, AFrozenCounterIsRefusedUntilItMoves) {
  Wheel wheel(counter());
  wheel.roll(1, 1, 1);
  const std::int64_t stuck = wheel.raw();
  for (int i = 0; i < 50; ++i) {
    wheel.t_ns += 10 * kMillisecond;
    EXPECT_EQ(wheel.send(stuck), Refusal::frozen) << i;
  }
  wheel.way += 0.5;
  EXPECT_EQ(wheel.roll(1, 1, 1), 0);
  EXPECT_NEAR(wheel.odometer.distance(), wheel.way - 0.01, 0.0003);
}

TEST(Odometer, AWheelThatWasBlockedIsBelievedAfterASecond) {
  for (const int interval : {1, 2, 5, 10, 20}) {
    Wheel wheel(counter(), interval * kMillisecond);
    wheel.roll(1, 1, 1);
    EXPECT_EQ(wheel.roll(3, 0, 0), 1000 / interval);
    EXPECT_EQ(wheel.seen[Refusal::frozen], 1000 / interval);
    EXPECT_EQ(wheel.roll(1, 0, 1), 0);
    EXPECT_NEAR(wheel.odometer.distance(), 1.5 - interval * 0.001, 0.0003);
  }
}

TEST(Odometer, ACounterOlderThanItsFramesIsNotFrozen) {
  // Sent every 10 ms, counted every 20 ms.
  Wheel wheel(counter(), 20 * kMillisecond);
  for (int i = 0; i < 200; ++i) {
    EXPECT_EQ(wheel.roll(0.02, 1, 1), 0);
    EXPECT_EQ(wheel.send(wheel.raw(), wheel.t_ns + 10 * kMillisecond), Refusal::none);
  }
}

TEST(Odometer, AfterAGapACounterGoesOnWithTheDifference) {
  Wheel wheel(counter());
  wheel.first_count = 1'000'000;
  wheel.roll(1, 1, 1);
  wheel.pause(3);
  wheel.way += 3.5;
  EXPECT_EQ(wheel.roll(1, 1, 1), 0);
  EXPECT_NEAR(wheel.odometer.distance(), wheel.way - 0.01, 0.0003);
  EXPECT_EQ(wheel.odometer.rebased(), 0U);
}

TEST(Odometer, AfterAGapInWhichItMayHaveWrappedTheDistanceStands) {
  Wheel wheel(counter(16));  // wraps after 10.3 m
  wheel.roll(1, 1, 1);
  wheel.pause(3);
  wheel.way += 9;
  EXPECT_EQ(wheel.roll(1, 1, 1), 0);
  EXPECT_NEAR(wheel.odometer.distance(), 0.99 + 0.99, 0.0006);
  EXPECT_EQ(wheel.odometer.rebased(), 1U);
}

TEST(Odometer, ADeviceThatRestartedInAGapDoesNotMakeTheDistanceJump) {
  Wheel wheel(counter());
  wheel.first_count = 100'000;
  wheel.roll(1, 1, 1);  // 16.7 m from zero
  wheel.pause(6);
  wheel.first_count = -static_cast<std::int64_t>((wheel.way - 0.2) / 0.000157);
  EXPECT_EQ(wheel.roll(1, 1, 1), 0);
  EXPECT_NEAR(wheel.odometer.distance(), 0.99 + 0.99, 0.0006);
  EXPECT_EQ(wheel.odometer.rebased(), 1U);
}

TEST(Odometer, ARobotThatReversesTowardsZeroInAGapHasNotRestarted) {
  Wheel wheel(counter());
  wheel.roll(5, 1, 1);
  wheel.roll(1, -1, -1);  // 4 m from zero
  wheel.pause(3);
  wheel.way -= 3.1;
  EXPECT_EQ(wheel.roll(0.5, -1, -1), 0);
  EXPECT_NEAR(wheel.odometer.distance(), wheel.way - 0.01, 0.0003);
  EXPECT_EQ(wheel.odometer.rebased(), 0U);
}

TEST(Odometer, RepeatedAndLateStampsAreRefused) {
  Wheel wheel(counter());
  wheel.roll(1, 1, 1);
  EXPECT_EQ(wheel.send(wheel.raw()), Refusal::time);
  EXPECT_EQ(wheel.send(wheel.raw(), wheel.t_ns - 3 * kMillisecond), Refusal::time);
  EXPECT_EQ(wheel.roll(1, 1, 1), 0);
  EXPECT_NEAR(wheel.odometer.distance(), wheel.way - 0.01, 0.0003);
}

TEST(Odometer, FollowsAHostClockThatIsSet) {
  for (const double hours : {-1.0, 1.0}) {
    Wheel wheel(counter());
    wheel.roll(1, 1, 1);
    wheel.pause(3600 * hours);
    EXPECT_LE(wheel.roll(1, 1, 1), 6);
    EXPECT_NEAR(wheel.odometer.distance(), wheel.way - 0.01, 0.011);
  }
}

TEST(Odometer, SpeedIsSummedOverTime) {
  Wheel wheel(speed_signal());
  wheel.send(0);
  EXPECT_EQ(wheel.roll(2, 0, 1.5), 0);
  EXPECT_EQ(wheel.roll(2, 1.5, -0.5), 0);
  EXPECT_NEAR(wheel.odometer.distance(), 1.5 + 1, 0.002);
}

TEST(Odometer, AGarbledSpeedIsRefused) {
  Wheel wheel(speed_signal());
  wheel.roll(1, 1, 1);
  const double before = wheel.odometer.distance();
  for (const int garbled : {3000, 32767, -32768, -1000}) {
    wheel.t_ns += 5 * kMillisecond;
    EXPECT_EQ(wheel.send(garbled), Refusal::implausible) << garbled;
    wheel.t_ns += 5 * kMillisecond;
    EXPECT_EQ(wheel.send(1000), Refusal::none);
  }
  EXPECT_NEAR(wheel.odometer.distance(), before + 0.04, 1e-9);
}

TEST(Odometer, ASpeedThatJumpsAndStaysIsBelievedSoon) {
  Wheel wheel(speed_signal());
  wheel.roll(1, 3, 3);
  const int refused = wheel.roll(2, 0, 0);  // blocked
  EXPECT_GE(refused, 3);
  EXPECT_LE(refused, 10);
  EXPECT_EQ(wheel.odometer.rebased(), 1U);
  EXPECT_NEAR(wheel.odometer.distance(), 2.97, 0.001);
}

TEST(Odometer, ASpeedBeyondTheLimitIsRefusedFromTheFirstOn) {
  Wheel wheel(speed_signal());
  EXPECT_EQ(wheel.roll(1, 6, 6), 100);
  EXPECT_EQ(wheel.roll(1, 4, 4), 0 + wheel.seen[Refusal::implausible] - 100);
  EXPECT_LE(wheel.seen[Refusal::implausible], 110);
}

TEST(Odometer, ASpeedIsNotSummedOverAGap) {
  Wheel wheel(speed_signal());
  wheel.roll(1, 1, 1);
  wheel.pause(5);
  EXPECT_EQ(wheel.roll(1, 1, 1), 0);
  EXPECT_NEAR(wheel.odometer.distance(), 0.99 + 0.99, 1e-6);
  EXPECT_EQ(wheel.odometer.rebased(), 1U);
}

TEST(Odometer, AnyReadingsAreSafe) {
  std::mt19937_64 random(1);
  for (const int length : {1, 8, 31, 64}) {
    for (const EncoderKind kind : {EncoderKind::counter, EncoderKind::speed}) {
      EncoderSettings settings = counter(length);
      settings.kind = kind;
      Odometer odometer(settings);
      std::int64_t t_ns = 0;
      for (int i = 0; i < 20'000; ++i) {
        if (i % 50 == 0) t_ns = static_cast<std::int64_t>(random() >> 1U);
        if (t_ns < INT64_MAX - 20 * kMillisecond)
          t_ns += static_cast<std::int64_t>(random() % (20 * kMillisecond));
        const auto raw = static_cast<std::int64_t>(i % 3 == 0 ? random() : 7U);
        odometer.take({t_ns, raw, scaled(settings, raw)});
        ASSERT_TRUE(std::isfinite(odometer.distance()));
      }
    }
  }
}

}  // namespace
}  // namespace scree::encoder
