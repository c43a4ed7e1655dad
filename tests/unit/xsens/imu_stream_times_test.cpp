#include "scree/drivers/xsens/imu_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "scree/core/nanoseconds.hpp"
#include "unit/xsens/imu_listener.hpp"

namespace scree::xsens {
namespace {

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

TEST(ImuStreamTimes, TimesAreTheSamplesOwnWhateverTheLineDoes) {
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

TEST(ImuStreamTimes, TimesNeverGoBack) {
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

TEST(ImuStreamTimes, CountsWhatTheCounterMisses) {
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

TEST(ImuStreamTimes, WithoutACounterTheSampleTimeTellsTheOrder) {
  Listener listener;
  Steady send(listener);
  for (const std::uint64_t ticks : {0xFFFFFFF0ULL, 84ULL, 184ULL, 184ULL, 84ULL, 284ULL}) {
    send({tick(ticks), kRate});
  }
  EXPECT_EQ(listener.samples.size(), 4U);
  EXPECT_EQ(listener.refused(Refusal::duplicate), 1U);
  EXPECT_EQ(listener.refused(Refusal::late), 1U);
}

TEST(ImuStreamTimes, ADeviceThatStartsOverIsFollowed) {
  Listener listener;
  Steady send(listener);
  for (unsigned i = 0; i < 300; ++i) send({counter(5000 + i), tick(900'000 + 100 * i), kRate});
  send.now_ns += 3 * kSecond;
  for (unsigned i = 0; i < 300; ++i) send({counter(i), tick(5 + 100 * i), kRate});
  EXPECT_EQ(listener.samples.size(), 600U);
  EXPECT_EQ(listener.stream.counters().device_restarts, 1U);
  const auto first = std::ranges::find(listener.samples, true, &ImuSample::started_over);
  EXPECT_NEAR(static_cast<double>(first - listener.samples.begin()), 305, 5) << "soon";
  EXPECT_EQ(listener.stream.counters().lost, 0U);
  EXPECT_NEAR(static_cast<double>(listener.samples[599].t_ns - listener.samples[299].t_ns),
              3e9 + 3e9, 1e6);
}

TEST(ImuStreamTimes, AfterALongSilenceNothingIsComparedWithBefore) {
  Listener listener;
  Steady send(listener);
  send({counter(10), tick(1000), kRate});
  send.now_ns += 600 * kSecond;
  send({counter(10), tick(6'001'100), kRate});
  EXPECT_EQ(listener.samples.size(), 2U);
  EXPECT_EQ(listener.stream.counters().lost, 0U);
  EXPECT_EQ(listener.stream.counters().device_restarts, 0U);
}

TEST(ImuStreamTimes, UtcServesWhereTheSampleTimeIsMissing) {
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

TEST(ImuStreamTimes, ElseTheCounterAtTheUsualRateNearby) {
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

TEST(ImuStreamTimes, ACountedRateIsMeasuredAnewAfterASilence) {
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

TEST(ImuStreamTimes, ElseTheArrival) {
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

}  // namespace
}  // namespace scree::xsens
