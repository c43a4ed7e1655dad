#include "scree/sync/sync_buffer.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "allocation_counter.hpp"
#include "scree/core/nanoseconds.hpp"
#include "scree/core/pose.hpp"
#include "scree/core/rotation.hpp"

namespace scree {
namespace {

constexpr std::int64_t kStart = 1'598'612'523'000'000'000;
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

ImuSample turning(std::int64_t t_ns, const Eigen::Vector3d& rate) {
  ImuSample sample;
  sample.t_ns = kStart + t_ns;
  sample.has_orientation = sample.has_rate = true;
  sample.orientation =
      from_roll_pitch_yaw(0.2, -0.1, 1.3) * exponential(rate * (static_cast<double>(t_ns) * 1e-9));
  sample.rate = rate;
  return sample;
}

EncoderSample rolled(std::int64_t t_ns, double distance) {
  EncoderSample sample;
  sample.t_ns = kStart + t_ns;
  sample.distance = distance;
  return sample;
}

class SyncBufferTest : public testing::Test {
protected:
  std::unique_ptr<SyncBuffer> buffer_ = std::make_unique<SyncBuffer>();

  void put(std::int64_t t_ns) {
    buffer_->put(turning(t_ns, {0, 0, 1}));
    buffer_->put(rolled(t_ns, static_cast<double>(t_ns) * 1e-9));
  }
  void put_until(std::int64_t begin_ns, std::int64_t end_ns) {
    for (std::int64_t t = begin_ns; t < end_ns; t += 10 * kMillisecond) put(t);
    buffer_->gather();
  }
};

TEST_F(SyncBufferTest, InterpolatesASteadyTurnExactly) {
  const Eigen::Vector3d rate(0.3, -0.5, 0.8);
  for (std::int64_t t = 0; t <= kSecond; t += 20 * kMillisecond) buffer_->put(turning(t, rate));
  buffer_->gather();
  // The last of these lie beyond the newest sample.
  for (std::int64_t t = 0; t <= kSecond + 99 * kMillisecond; t += 1'234'567) {
    const auto attitude = buffer_->attitude_at(kStart + t);
    ASSERT_TRUE(attitude) << t;
    EXPECT_LT(attitude->rotation.angularDistance(turning(t, rate).orientation), 1e-7) << t;
    EXPECT_LT((attitude->rate - rate).norm(), 1e-12) << t;
  }
}

/// What comes late was measured earlier.
TEST_F(SyncBufferTest, TakesOffADelay) {
  const SampleDelays delays{.imu_ns = 80 * kMillisecond, .wheel_ns = -20 * kMillisecond};
  SyncBuffer late(Eigen::Quaterniond::Identity(), delays);
  for (std::int64_t t = 0; t <= kSecond; t += 10 * kMillisecond) {
    ImuSample imu = turning(t, {0, 0, 1});
    imu.t_ns += delays.imu_ns;
    EncoderSample wheel = rolled(t, static_cast<double>(t) * 1e-9);
    wheel.t_ns += delays.wheel_ns;
    late.put(imu);
    late.put(wheel);
  }
  late.gather();
  const std::int64_t half = kSecond / 2;
  EXPECT_LT(late.attitude_at(kStart + half)
                ->rotation.angularDistance(turning(half, {0, 0, 1}).orientation),
            1e-9);
  EXPECT_NEAR(late.wheel_at(kStart + half)->distance, 0.5, 1e-9);
  // The next of the IMU's samples comes 90 ms later, and it is not silent meanwhile.
  EXPECT_FALSE(late.covers(kStart + kSecond + 200 * kMillisecond));
  EXPECT_TRUE(late.covers(kStart + kSecond + 240 * kMillisecond));
}

TEST_F(SyncBufferTest, TurnsTheShorterWayWhenTheQuaternionChangesItsSign) {
  const Eigen::Vector3d rate(0, 0, 0.5);
  ImuSample second = turning(20 * kMillisecond, rate);
  second.orientation.coeffs() *= -1;
  buffer_->put(turning(0, rate));
  buffer_->put(second);
  buffer_->gather();
  const auto attitude = buffer_->attitude_at(kStart + 10 * kMillisecond);
  ASSERT_TRUE(attitude);
  const auto middle = turning(10 * kMillisecond, rate).orientation;
  EXPECT_LT(attitude->rotation.angularDistance(middle), 1e-7);
}

TEST_F(SyncBufferTest, TakesTheRateFromOrientationsWhereNoneIsSent) {
  const Eigen::Vector3d rate(0.3, -0.5, 0.8);
  for (std::int64_t t = 0; t <= 100 * kMillisecond; t += 10 * kMillisecond) {
    ImuSample sample = turning(t, rate);
    sample.has_rate = false;
    sample.rate.setConstant(99);
    buffer_->put(sample);
  }
  buffer_->gather();
  for (const std::int64_t t : {33 * kMillisecond, 100 * kMillisecond, 150 * kMillisecond}) {
    const auto attitude = buffer_->attitude_at(kStart + t);
    ASSERT_TRUE(attitude);
    EXPECT_LT((attitude->rate - rate).norm(), 1e-6) << t;
    EXPECT_LT(attitude->rotation.angularDistance(turning(t, rate).orientation), 1e-6) << t;
  }
}

TEST_F(SyncBufferTest, InterpolatesTheWheelAndGoesOnWithItsSpeed) {
  for (int i = 0; i <= 10; ++i) buffer_->put(rolled(i * 10 * kMillisecond, -0.02 * i));
  buffer_->gather();
  for (std::int64_t t = 0; t <= 190 * kMillisecond; t += 1'234'567) {
    const auto wheel = buffer_->wheel_at(kStart + t);
    ASSERT_TRUE(wheel) << t;
    EXPECT_NEAR(wheel->distance, -2e-9 * static_cast<double>(t), 1e-9) << t;
    EXPECT_NEAR(wheel->speed, -2, 1e-6) << t;
  }
}

TEST_F(SyncBufferTest, KnowsNothingBeforeTheFirstSampleAndInSilence) {
  put_until(0, 500 * kMillisecond);
  put_until(800 * kMillisecond, kSecond);
  const auto is_known = [&](std::int64_t t) {
    EXPECT_EQ(buffer_->attitude_at(kStart + t).has_value(),
              buffer_->wheel_at(kStart + t).has_value());
    return buffer_->wheel_at(kStart + t).has_value();
  };
  EXPECT_FALSE(is_known(-1));
  EXPECT_TRUE(is_known(0));
  EXPECT_TRUE(is_known(490 * kMillisecond));
  EXPECT_TRUE(is_known(640 * kMillisecond)) << "as if nothing had followed yet";
  EXPECT_FALSE(is_known(641 * kMillisecond));
  EXPECT_FALSE(is_known(799 * kMillisecond));
  EXPECT_TRUE(is_known(800 * kMillisecond));
  EXPECT_TRUE(is_known(kSecond + 140 * kMillisecond));
  EXPECT_FALSE(is_known(kSecond + 141 * kMillisecond));
}

TEST_F(SyncBufferTest, CoversWhatIsThereOrWillNotCome) {
  EXPECT_TRUE(buffer_->covers(kStart)) << "no sensor";
  EXPECT_FALSE(buffer_->has_motion());
  put_until(0, 500 * kMillisecond);
  EXPECT_TRUE(buffer_->has_motion());
  EXPECT_TRUE(buffer_->covers(kStart + 490 * kMillisecond));
  EXPECT_FALSE(buffer_->covers(kStart + 500 * kMillisecond)) << "worth waiting for";
  EXPECT_TRUE(buffer_->covers(kStart + 700 * kMillisecond)) << "silent";
  buffer_->put(turning(500 * kMillisecond, {0, 0, 1}));
  buffer_->gather();
  EXPECT_FALSE(buffer_->covers(kStart + 500 * kMillisecond)) << "the wheel is still to come";
}

TEST_F(SyncBufferTest, PassesOverImuSamplesWithoutAnOrientation) {
  put_until(0, 100 * kMillisecond);
  ImuSample high_rate = turning(95 * kMillisecond, {0, 0, 1});
  high_rate.has_orientation = false;
  EXPECT_TRUE(buffer_->put(high_rate));
  buffer_->gather();
  EXPECT_EQ(buffer_->imu().size(), 10U);
  EXPECT_EQ(buffer_->late(), 0U);
}

TEST_F(SyncBufferTest, GivesAnAttitudeOfRatesAndAccelerationsWhereNoneIsSent) {
  for (std::int64_t t = 0; t < 6 * kSecond; t += 10 * kMillisecond) {
    ImuSample sample = turning(t, {0, 0, 0.5});
    sample.acceleration = sample.orientation.conjugate() * Eigen::Vector3d(0, 0, 9.81);
    sample.has_orientation = false;
    sample.has_acceleration = true;
    buffer_->put(sample);
  }
  buffer_->gather();
  EXPECT_EQ(buffer_->late(), 0U);
  EXPECT_FALSE(buffer_->attitude_at(kStart + kSecond / 4));
  const auto before = buffer_->attitude_at(kStart + 5 * kSecond);
  const auto after = buffer_->attitude_at(kStart + 11 * kSecond / 2);
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(logarithm(before->rotation.conjugate() * after->rotation).z(), 0.25, 1e-3);
}

TEST_F(SyncBufferTest, AnEncoderOfTenFramesASecondIsNotSilent) {
  for (int i = 0; i < 10; ++i) buffer_->put(rolled(i * 101 * kMillisecond, 0.2 * i));
  buffer_->gather();
  for (std::int64_t t = 0; t < 909 * kMillisecond; t += kMillisecond) {
    const auto wheel = buffer_->wheel_at(kStart + t);
    ASSERT_TRUE(wheel);
    ASSERT_NEAR(wheel->distance, 0.2 * static_cast<double>(t) / (101.0 * kMillisecond), 1e-9);
  }
}

TEST_F(SyncBufferTest, RefusesWhatIsOldOrNoNumber) {
  put_until(0, 100 * kMillisecond);
  ImuSample imu = turning(200 * kMillisecond, {0, 0, kNotANumber});
  buffer_->put(imu);
  imu = turning(200 * kMillisecond, {0, 0, 1});
  imu.orientation.coeffs().setZero();
  buffer_->put(imu);
  imu.orientation.coeffs().setConstant(kNotANumber);
  buffer_->put(imu);
  buffer_->put(rolled(200 * kMillisecond, kNotANumber));
  buffer_->put(rolled(200 * kMillisecond, std::numeric_limits<double>::infinity()));
  put(50 * kMillisecond);
  put(90 * kMillisecond);
  buffer_->gather();
  EXPECT_EQ(buffer_->late(), 9U);
  EXPECT_EQ(buffer_->imu().size(), 10U);
  EXPECT_EQ(buffer_->wheel().size(), 10U);
  EXPECT_EQ(buffer_->dropped(), 0U);
}

TEST_F(SyncBufferTest, RefusesWhatNoSensorCanHaveMeasured) {
  put_until(0, 100 * kMillisecond);
  constexpr auto kEarliest = std::numeric_limits<std::int64_t>::min(),
                 kLatest = std::numeric_limits<std::int64_t>::max();
  for (const double distance : {1e308, -1e308, 1e12, 100.0, -100.0}) {
    buffer_->put(rolled(100 * kMillisecond, distance));
  }
  for (const std::int64_t t : {kEarliest, kLatest}) {
    EncoderSample wheel = rolled(0, 0.1);
    wheel.t_ns = t;
    buffer_->put(wheel);
    ImuSample imu = turning(0, {0, 0, 1});
    imu.t_ns = t;
    buffer_->put(imu);
  }
  buffer_->put(turning(100 * kMillisecond, {0, 0, 1e308}));
  buffer_->gather();
  EXPECT_EQ(buffer_->late(), 10U);
  EXPECT_EQ(buffer_->wheel().size(), 10U);
  buffer_->put(rolled(100 * kMillisecond, 0.1));
  buffer_->put(rolled(900 * kMillisecond, 500));
  buffer_->gather();
  EXPECT_EQ(buffer_->wheel().size(), 12U) << "after silence the wheel begins anew";
}

TEST_F(SyncBufferTest, WhatStandsInThePlaceOfAnAbsentValueIsNotUsed) {
  for (const std::int64_t t_ns : {0L, 20 * kMillisecond}) {
    ImuSample imu = turning(t_ns, {0, 0, 1});
    imu.has_rate = imu.has_acceleration = false;
    imu.rate.setConstant(1e308);
    imu.acceleration.setConstant(kNotANumber);
    buffer_->put(imu);
    buffer_->gather();
    const auto attitude = buffer_->attitude_at(kStart + t_ns + 10 * kMillisecond);
    ASSERT_TRUE(attitude) << t_ns;
    EXPECT_LT(attitude->rate.norm(), 2) << t_ns;
    EXPECT_NEAR(attitude->rotation.norm(), 1, 1e-9) << t_ns;
  }
  EXPECT_EQ(buffer_->late(), 0U);
}

TEST_F(SyncBufferTest, GoesOnWhenTheClockWasSetBackOrASampleCameFromTheFuture) {
  put_until(0, kSecond);
  put_until(-3600 * kSecond, -3599 * kSecond);
  EXPECT_TRUE(buffer_->attitude_at(kStart - 3600 * kSecond + 55 * kMillisecond));
  EXPECT_TRUE(buffer_->wheel_at(kStart - 3600 * kSecond + 55 * kMillisecond));
  put(1'000'000 * kSecond);
  put_until(-3599 * kSecond, -3598 * kSecond);
  EXPECT_TRUE(buffer_->attitude_at(kStart - 3599 * kSecond + 55 * kMillisecond));
  EXPECT_TRUE(buffer_->wheel_at(kStart - 3599 * kSecond + 55 * kMillisecond));
  EXPECT_EQ(buffer_->late(), 0U);
}

TEST_F(SyncBufferTest, DropsAndCountsWhatFindsNoRoomAndKeepsTheNewestOfTheRest) {
  std::uint64_t refused = 0;
  for (int i = 0; i < 10'000; ++i) refused += buffer_->put(rolled(i, i)) ? 0 : 1;
  EXPECT_GT(refused, 0U);
  EXPECT_EQ(buffer_->dropped(), refused);
  buffer_->gather();
  EXPECT_EQ(buffer_->wheel().size(), 10'000 - refused);
  EXPECT_EQ(buffer_->wheel()[0].distance, 0) << "the new ones are those dropped";

  const std::size_t kept = buffer_->wheel().size();
  for (int i = 0; i < 50'000; ++i) {
    buffer_->put(rolled(20'000 + i, i));
    if (i % 1000 == 999) buffer_->gather();
  }
  EXPECT_EQ(buffer_->dropped(), refused);
  EXPECT_EQ(buffer_->wheel().newest().distance, 49'999);
  EXPECT_LE(buffer_->wheel().size(), kept) << "history is bounded";
}

TEST_F(SyncBufferTest, SaysHowFullItsRingsAreAndWere) {
  for (int i = 0; i < 3; ++i) put(i * kMillisecond);
  buffer_->put(rolled(3 * kMillisecond, 1));
  EXPECT_EQ(buffer_->imu_fill().waiting, 3U);
  EXPECT_EQ(buffer_->wheel_fill().waiting, 4U);
  buffer_->gather();
  put(9 * kMillisecond);
  EXPECT_EQ(buffer_->imu_fill().waiting, 1U);
  EXPECT_EQ(buffer_->imu_fill().most, 3U);
  EXPECT_EQ(buffer_->wheel_fill().most, 4U);
  for (std::int64_t t = 10; buffer_->put(rolled(t * kMillisecond, 1)); ++t) {
  }
  EXPECT_EQ(buffer_->wheel_fill().waiting, buffer_->wheel_fill().capacity);
  EXPECT_EQ(buffer_->wheel_fill().most, buffer_->wheel_fill().capacity);
}

TEST_F(SyncBufferTest, AllocatesNothing) {
  const std::size_t before = test::allocations();
  for (std::int64_t second = 0; second < 60; ++second) {
    put_until(second * kSecond, (second + 1) * kSecond);
    EXPECT_TRUE(buffer_->attitude_at(kStart + second * kSecond + 77));
    EXPECT_TRUE(buffer_->wheel_at(kStart + second * kSecond + 77));
  }
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace scree
