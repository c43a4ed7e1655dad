#include "scree/drivers/xsens/imu_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/allocation_counter.hpp"
#include "unit/xsens/imu_listener.hpp"

namespace scree::xsens {
namespace {

using test::joined;

TEST(ImuStream, RatesAndForcesComeFromTheBestThereIs) {
  Listener listener;
  Steady send(listener);
  const ByteVector high_rate = reals(0x8043, {-1, -2, -3}), high_force = reals(0x4042, {4, 5, 6});
  const double half = 0.02 / 2;  // 2 rad/s about y for 10 ms
  const ByteVector turned = reals(0x8033, {std::cos(half), 0, std::sin(half), 0});
  const ByteVector pushed = reals(0x4013, {0.0975, 0, -0.01});
  unsigned i = 0;
  const auto sample = [&](std::initializer_list<ByteVector> items) {
    send({counter(i), tick(100 * i), joined(items)});
    ++i;
    return listener.samples.back();
  };
  EXPECT_EQ(sample({high_rate, kRate, kForce, high_force}).rate, Eigen::Vector3d(0.5, -0.25, 2));
  EXPECT_EQ(listener.samples.back().acceleration, Eigen::Vector3d(1, 2, 9.75));
  EXPECT_EQ(sample({turned, high_rate, high_force, pushed}).rate, Eigen::Vector3d(-1, -2, -3));
  EXPECT_EQ(listener.samples.back().acceleration, Eigen::Vector3d(4, 5, 6));
  for (const int lost : {0, 0, 1, 3}) {
    i += static_cast<unsigned>(lost);
    send.now_ns += lost * 10 * kMillisecond;
    const ImuSample from_increments = sample({turned, pushed, kTurn});
    ASSERT_TRUE(from_increments.has_rate && from_increments.has_acceleration);
    EXPECT_LT((from_increments.rate - Eigen::Vector3d(0, 2, 0)).norm(), 1e-9);
    EXPECT_LT((from_increments.acceleration - Eigen::Vector3d(9.75, 0, -1)).norm(), 1e-9);
  }
  // The same turn with the other sign of the quaternion.
  const ImuSample other = sample({reals(0x8033, {-std::cos(half), 0, -std::sin(half), 0})});
  EXPECT_LT((other.rate - Eigen::Vector3d(0, 2, 0)).norm(), 1e-9);
  EXPECT_FALSE(other.has_acceleration || other.has_orientation);
}

TEST(ImuStream, TheFirstIncrementsHaveNoInterval) {
  Listener listener;
  Steady send(listener);
  send({counter(0), tick(0), reals(0x4010, {0.1, 0, 0}), kTurn});
  EXPECT_FALSE(listener.samples.at(0).has_acceleration);
  send({counter(1), tick(100), reals(0x4010, {0.1, 0, 0}), kTurn});
  EXPECT_TRUE(listener.samples.at(1).has_acceleration);
}

TEST(ImuStream, OrientationIsTheQuaternionElseTheMatrixElseTheAngles) {
  Listener listener;
  Steady send(listener);
  const ByteVector matrix = reals(0x2020, {0, 1, 0, -1, 0, 0, 0, 0, 1});  // a quarter turn left
  const ByteVector angles = reals(0x2034, {180, 0, 0});  // level and north, in north-east-down
  send({counter(0), angles, matrix, kTurn});
  send({counter(1), angles, matrix});
  send({counter(2), angles});
  send({counter(3), kForce});
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), z = Eigen::Vector3d::UnitZ();
  EXPECT_LT((listener.samples[0].orientation * x - x).norm(), 1e-9);
  EXPECT_LT((listener.samples[1].orientation * x - Eigen::Vector3d::UnitY()).norm(), 1e-6);
  EXPECT_LT((listener.samples[2].orientation * x - Eigen::Vector3d::UnitY()).norm(), 1e-6);
  EXPECT_LT((listener.samples[2].orientation * z - z).norm(), 1e-6);
  EXPECT_FALSE(listener.samples[3].has_orientation);
}

TEST(ImuStream, WhatIsWrongInAMessageIsLeftOutOfItsSample) {
  Listener listener;
  Steady send(listener);
  send({counter(0), tick(0), reals(0x2010, {2, 0, 0, 0}), reals(0x8020, {0, NAN, 0}), kForce});
  ASSERT_EQ(listener.samples.size(), 1U);
  EXPECT_FALSE(listener.samples[0].has_orientation || listener.samples[0].has_rate);
  EXPECT_TRUE(listener.samples[0].has_acceleration);
  EXPECT_EQ(listener.refused(Refusal::not_unit), 1U);
  EXPECT_EQ(listener.refused(Refusal::not_finite), 1U);
  send({reals(0x8020, {NAN, NAN, NAN})});
  EXPECT_EQ(listener.refused(Refusal::empty), 1U);
  EXPECT_EQ(listener.measured_ns.size(), 1U);
}

TEST(ImuStream, NoMessageIsBelievedWithNumbersThatNoImuMeasures) {
  Listener listener;
  Steady send(listener);
  send({counter(0), tick(0), kTurn, kRate, kForce});
  send({counter(999), tick(70000), kTurn, kRate, reals(0x4020, {0, 1e30, 0})});
  send({counter(999), tick(70000), kTurn, reals(0x8020, {0, 0, -100}), kForce});
  send({counter(999), tick(70000), reals(0x4042, {400, 0, 0})});
  EXPECT_EQ(listener.samples.size(), 1U);
  EXPECT_EQ(listener.refused(Refusal::implausible), 3U);
  send({counter(4), tick(400), kTurn, reals(0x8020, {0, 34, 0}), reals(0x4020, {0, 98, 98})});
  EXPECT_EQ(listener.samples.size(), 2U);
  EXPECT_EQ(listener.stream.counters().lost, 3U);
}

TEST(ImuStream, NoMoreAreLostThanAnMtiSendsMeanwhile) {
  Listener listener;
  Steady send(listener);
  const auto lost_after = [&](unsigned counted, std::int64_t silent_ns) {
    const std::uint64_t before = listener.stream.counters().lost;
    send.now_ns += silent_ns;
    send({counter(counted), kTurn, kRate, kForce});
    return listener.stream.counters().lost - before;
  };
  lost_after(10, 0);
  EXPECT_EQ(lost_after(61, 500 * kMillisecond), 50U);
  EXPECT_EQ(lost_after(861, 400 * kMillisecond), 799U);   // at 2 kHz
  EXPECT_EQ(lost_after(20'000, 400 * kMillisecond), 0U);  // garbled: 49 times as fast
  EXPECT_EQ(lost_after(20'001, 0), 0U);
  EXPECT_EQ(lost_after(1, 3000 * kMillisecond), 0U);       // started over: no step forward
  EXPECT_EQ(lost_after(30'000, 3000 * kMillisecond), 0U);  // started over: a step of 29,999
}

TEST(ImuStream, OtherMessagesAreCountedAndNoSamples) {
  Listener listener;
  listener.stream.take(joined({test::message(0x3E, {}), test::message(0x42, {4}),
                               data_message({counter(1), integer(0x3010, 101325, 4)})}),
                       kEpoch);
  EXPECT_EQ(listener.stream.counters().other_messages, 2U);
  EXPECT_EQ(listener.stream.counters().accepted, 1U);
  EXPECT_TRUE(listener.samples.empty());
  EXPECT_EQ(listener.measured_ns, std::vector<std::int64_t>{kEpoch});
}

TEST(ImuStream, TheEndOfACaptureIsSearchedToo) {
  Listener listener;
  listener.stream.take(joined({{0xFA, 0xFF, 0x36, 0xF0}, data_message({counter(1), kRate})}),
                       kEpoch);
  EXPECT_TRUE(listener.samples.empty());
  listener.stream.flush();
  EXPECT_EQ(listener.samples.size(), 1U);
  EXPECT_EQ(listener.stream.counters().bytes_skipped, 4U);
}

TEST(ImuStream, AnyBytesAreSafeAndTakeNoMemory) {
  std::mt19937 random(17);
  std::uint64_t samples = 0;
  ImuStream stream(
      ImuSettings{},
      [&](const ImuSample& sample) {
        ++samples;
        ASSERT_TRUE(sample.rate.allFinite() && sample.acceleration.allFinite() &&
                    sample.orientation.coeffs().allFinite());
      },
      [](std::int64_t, const Measurement&) {});
  std::int64_t now = kEpoch;
  for (unsigned i = 0; i < 20000; ++i) {
    ByteVector bytes =
        data_message({counter(i + static_cast<unsigned>(random() % 3)), tick(100ULL * i), kTurn,
                      kRate, reals(0x8030, {1, 0, 0, 0}), reals(0x4010, {1, 2, 3})});
    if (random() % 4 == 0) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    if (random() % 50 == 0)
      now += static_cast<std::int64_t>(random() % 1'000'000'000'000) - 500'000'000'000;
    if (random() % 10 == 0) {
      bytes = data_message({counter(static_cast<unsigned>(random())), tick(random()), kRate});
    }
    now += static_cast<std::int64_t>(random() % 20'000'000);
    const std::size_t before = test::allocations();
    stream.take(bytes, now);
    ASSERT_EQ(test::allocations(), before);
  }
  EXPECT_GT(samples, 5000U);
  EXPECT_GT(stream.counters().all_refused(), 1000U);
}

}  // namespace
}  // namespace scree::xsens
