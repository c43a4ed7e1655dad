#include "scree/drivers/xsens/imu_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "scree/core/nanoseconds.hpp"
#include "unit/allocation_counter.hpp"
#include "unit/xsens/message_builder.hpp"

namespace scree::xsens {
namespace {

using test::ByteVector;
using test::data_message;
using test::integer;
using test::joined;
using test::reals;

constexpr std::int64_t kEpoch = 1'598'612'523 * kSecond;

ByteVector counter(unsigned value) {
  return integer(0x1020, value & 0xFFFFU, 2);
}
ByteVector tick(std::uint64_t value) {
  return integer(0x1060, value & 0xFFFFFFFFU, 4);
}
const ByteVector kTurn = reals(0x2010, {1, 0, 0, 0});
const ByteVector kRate = reals(0x8020, {0.5, -0.25, 2});
const ByteVector kForce = reals(0x4020, {1, 2, 9.75});

/// A stream and what it gave.
struct Listener {
  std::vector<ImuSample> samples;
  std::vector<std::int64_t> measured_ns;
  ImuStream stream;

  explicit Listener(int baud = 921600)
      : stream(
            settings(baud), [this](const ImuSample& sample) { samples.push_back(sample); },
            [this](std::int64_t t_ns, const Measurement&) { measured_ns.push_back(t_ns); }) {}
  static ImuSettings settings(int baud) {
    ImuSettings imu;
    imu.baud = baud;
    return imu;
  }
  std::uint64_t refused(Refusal reason) const {
    return stream.counters().refused[static_cast<std::size_t>(reason)];
  }
};

/// What a device sends, at its times, over a serial line and an adapter that hands on what it has
/// every `burst_ns`.
class Line {
public:
  Line(int baud, std::int64_t burst_ns) : byte_ns_(1e10 / baud), burst_ns_(burst_ns) {}

  void send(std::int64_t sent_ns, const ByteVector& bytes, ImuStream& stream) {
    double t = static_cast<double>(std::max(free_ns_, sent_ns - kEpoch));
    for (const std::uint8_t byte : bytes) {
      t += byte_ns_;
      const auto now = static_cast<std::int64_t>(t);
      if (now > read_ns_) {
        read(stream);
        read_ns_ = burst_ns_ > 0 ? (now / burst_ns_ + 1) * burst_ns_ : now;
      }
      waiting_.push_back(byte);
    }
    free_ns_ = static_cast<std::int64_t>(t);
  }
  void read(ImuStream& stream) {
    // Scheduling costs the reader a moment.
    std::exponential_distribution<double> delay(1.0 / 30e3);
    if (!waiting_.empty()) {
      stream.take(waiting_, kEpoch + read_ns_ + static_cast<std::int64_t>(delay(random_)));
    }
    waiting_.clear();
  }

private:
  double byte_ns_;
  std::int64_t burst_ns_, free_ns_ = 0, read_ns_ = 0;
  ByteVector waiting_;
  std::mt19937 random_{3};
};

TEST(ImuStream, TimesAreTheSamplesOwnWhateverTheLineDoes) {
  struct Case {
    int baud, hertz;
    std::int64_t burst_ns;
    double ppm;
    std::int64_t tolerance_ns;
  };
  // A bursting adapter shows a sample without delay only when a burst ends with one.
  for (const Case& c :
       {Case{921600, 100, 0, 0, 150'000}, Case{921600, 400, 0, 40, 150'000},
        Case{115200, 100, 0, -40, 150'000}, Case{921600, 100, 16 * kMillisecond, 0, 2'200'000},
        Case{921600, 400, 16 * kMillisecond, 30, 1'000'000},
        Case{2'000'000, 1000, 16 * kMillisecond, -30, 1'000'000}}) {
    SCOPED_TRACE(testing::Message() << c.baud << " baud, " << c.hertz << " Hz, " << c.burst_ns);
    Listener listener(c.baud);
    Line line(c.baud, c.burst_ns);
    const std::int64_t count = 20 * c.hertz;
    std::vector<std::int64_t> truth;
    for (std::int64_t i = 0; i < count; ++i) {
      const double device = static_cast<double>(i) / c.hertz;
      const auto t = kEpoch + static_cast<std::int64_t>(device * 1e9 * (1 - c.ppm * 1e-6));
      truth.push_back(t);
      // Its clock wraps after ten seconds.
      const auto ticks = static_cast<std::uint64_t>(std::llround(device * 1e4));
      line.send(t,
                data_message({counter(static_cast<unsigned>(i)), tick(0xFFFFFFFF - 100'000 + ticks),
                              kTurn, kRate, kForce}),
                listener.stream);
    }
    line.read(listener.stream);
    ASSERT_EQ(listener.samples.size(), truth.size());
    EXPECT_EQ(listener.stream.counters().device_restarts, 0U);
    EXPECT_EQ(listener.stream.counters().host_steps, 0U);
    for (std::size_t i = static_cast<std::size_t>(2 * c.hertz); i < truth.size(); ++i) {
      ASSERT_LT(std::abs(listener.samples[i].t_ns - truth[i]), c.tolerance_ns) << i;
      ASSERT_GT(listener.samples[i].t_ns, listener.samples[i - 1].t_ns);
    }
  }
}

TEST(ImuStream, TimesNeverGoBack) {
  // The first sample comes with a burst, so the clock is found better and better.
  Listener listener;
  Line line(921600, 16 * kMillisecond);
  for (unsigned i = 0; i < 50; ++i) {
    line.send(kEpoch + i * kMillisecond, data_message({counter(i), tick(10 * i), kRate}),
              listener.stream);
  }
  line.read(listener.stream);
  ASSERT_EQ(listener.samples.size(), 50U);
  for (std::size_t i = 1; i < 50; ++i) {
    EXPECT_GT(listener.samples[i].t_ns, listener.samples[i - 1].t_ns);
  }
}

/// Sends one message every 10 ms.
class Steady {
public:
  explicit Steady(Listener& listener) : listener_(listener) {}
  void operator()(std::initializer_list<ByteVector> items) {
    listener_.stream.take(data_message(items), now_ns);
    now_ns += 10 * kMillisecond;
  }
  std::int64_t now_ns = kEpoch;

private:
  Listener& listener_;
};

TEST(ImuStream, CountsWhatTheCounterMisses) {
  Listener listener;
  Steady send(listener);
  for (const unsigned value : {65533U, 65534U, 65535U, 0U, 1U, 5U, 6U, 5U, 6U, 3U, 7U, 7U, 8U}) {
    const std::uint64_t ticks = 100ULL * (value < 1000 ? value + 65536 : value);
    listener.stream.take(data_message({counter(value), tick(ticks), kRate}),
                         kEpoch + static_cast<std::int64_t>(ticks) * kTickNs);
  }
  EXPECT_EQ(listener.stream.counters().accepted, 9U);
  EXPECT_EQ(listener.samples.size(), 9U);
  EXPECT_EQ(listener.stream.counters().lost, 3U);
  EXPECT_EQ(listener.refused(Refusal::late), 2U);
  EXPECT_EQ(listener.refused(Refusal::duplicate), 2U);
}

TEST(ImuStream, WithoutACounterTheSampleTimeTellsTheOrder) {
  Listener listener;
  Steady send(listener);
  for (const std::uint64_t ticks : {0xFFFFFFF0ULL, 84ULL, 184ULL, 184ULL, 84ULL, 284ULL}) {
    send({tick(ticks), kRate});
  }
  EXPECT_EQ(listener.samples.size(), 4U);
  EXPECT_EQ(listener.refused(Refusal::duplicate), 1U);
  EXPECT_EQ(listener.refused(Refusal::late), 1U);
}

TEST(ImuStream, ADeviceThatStartsOverIsFollowed) {
  Listener listener;
  Steady send(listener);
  for (unsigned i = 0; i < 300; ++i) send({counter(5000 + i), tick(900'000 + 100 * i), kRate});
  send.now_ns += 3 * kSecond;
  for (unsigned i = 0; i < 300; ++i) send({counter(i), tick(5 + 100 * i), kRate});
  EXPECT_EQ(listener.samples.size(), 600U);
  EXPECT_EQ(listener.stream.counters().device_restarts, 1U);
  EXPECT_EQ(listener.stream.counters().lost, 0U);
  EXPECT_NEAR(static_cast<double>(listener.samples[599].t_ns - listener.samples[299].t_ns),
              3e9 + 3e9, 1e6);
}

TEST(ImuStream, AfterALongSilenceNothingIsComparedWithBefore) {
  Listener listener;
  Steady send(listener);
  send({counter(10), tick(1000), kRate});
  send.now_ns += 600 * kSecond;
  send({counter(10), tick(6'001'100), kRate});
  EXPECT_EQ(listener.samples.size(), 2U);
  EXPECT_EQ(listener.stream.counters().lost, 0U);
  EXPECT_EQ(listener.stream.counters().device_restarts, 0U);
}

TEST(ImuStream, UtcServesWhereTheSampleTimeIsMissing) {
  Listener listener;
  std::mt19937 random(1);
  for (unsigned i = 0; i < 1000; ++i) {
    // 10 s about midnight; the host is late by up to 4 ms.
    const std::uint64_t since = 86'395'000 + 10 * i;
    ByteVector utc;
    test::put_unsigned(utc, since % 1000 * 1'000'000, 4);
    test::put_unsigned(utc, 2026, 2);
    for (const std::uint64_t field :
         {since >= 86'400'000 ? std::uint64_t{2} : 1, std::uint64_t{1}, since / 3'600'000 % 24,
          since / 60'000 % 60, since / 1000 % 60, std::uint64_t{7}}) {
      test::put_unsigned(utc, field, 1);
    }
    const std::int64_t late = i % 7 == 0 ? 0 : static_cast<std::int64_t>(random() % 4'000'000);
    listener.stream.take(data_message({test::item(0x1010, utc), counter(i), kRate}),
                         kEpoch + i * 10 * kMillisecond + late);
  }
  ASSERT_EQ(listener.samples.size(), 1000U);
  EXPECT_EQ(listener.stream.counters().device_restarts, 0U);
  for (std::size_t i = 100; i < 1000; ++i) {
    ASSERT_NEAR(static_cast<double>(listener.samples[i].t_ns - listener.samples[i - 1].t_ns), 1e7,
                3e4);
  }
}

TEST(ImuStream, ElseTheCounterAtTheUsualRateNearby) {
  for (const int hertz : {100, 400}) {
    Listener listener;
    std::mt19937 random(1);
    const std::int64_t period = kSecond / hertz;
    for (unsigned i = 0; i < 10U * static_cast<unsigned>(hertz); ++i) {
      if (i % 50 == 7) continue;  // lost
      const std::int64_t late = static_cast<std::int64_t>(random() % 2'000'000);
      listener.stream.take(data_message({counter(i), kRate}), kEpoch + i * period + late);
    }
    const auto& samples = listener.samples;
    for (std::size_t i = samples.size() / 2; i < samples.size(); ++i) {
      const std::int64_t step = samples[i].t_ns - samples[i - 1].t_ns;
      const std::int64_t periods = (step + period / 2) / period;
      ASSERT_NEAR(static_cast<double>(step - periods * period), 0, 2e5) << i;
    }
    EXPECT_EQ(listener.stream.counters().host_steps, 0U);
  }
}

TEST(ImuStream, ACountedRateIsMeasuredAnewAfterASilence) {
  Listener listener;
  std::int64_t t_ns = kEpoch;
  for (const int hertz : {100, 400}) {
    for (unsigned i = 0; i < 10U * static_cast<unsigned>(hertz); ++i) {
      t_ns += kSecond / hertz;
      listener.stream.take(data_message({counter(i), kRate}), t_ns);
      ASSERT_NEAR(static_cast<double>(listener.samples.back().t_ns - t_ns), 0, 5e6);
    }
    EXPECT_EQ(listener.stream.clock().state(), ClockState::estimated) << hertz;
    t_ns += 3 * kSecond;
  }
}

TEST(ImuStream, ElseTheArrival) {
  Listener listener;
  for (int i = 0; i < 300; ++i) {
    listener.stream.take(data_message({kRate}), kEpoch + i * 37 * kMillisecond + i % 3);
  }
  ASSERT_EQ(listener.samples.size(), 300U);
  for (int i = 0; i < 300; ++i) {
    EXPECT_EQ(listener.samples[static_cast<std::size_t>(i)].t_ns,
              kEpoch + i * 37 * kMillisecond + i % 3);
  }
}

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
