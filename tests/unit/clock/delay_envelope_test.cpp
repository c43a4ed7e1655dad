#include "scree/clock/delay_envelope.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

TEST(DelayEnvelope, FindsALineWithoutNoise) {
  for (const std::int64_t skew : {-200'000, -37'000, 0, 5'000, 200'000}) {
    DelayEnvelope envelope;
    const auto at = [&](std::int64_t t) {
      return ClockSample{t, 1'598'612'523 * kSecond + gained_ns(t, skew)};
    };
    envelope.reset(at(0));
    for (std::int64_t t = 0; t < 200 * kSecond; t += 10'000'000) envelope.add(at(t));
    EXPECT_NEAR(static_cast<double>(envelope.line().skew_ppb), static_cast<double>(skew), 20);
    EXPECT_NEAR(static_cast<double>(envelope.excess_ns(at(200 * kSecond))), 0, 1000);
  }
}

/// The line through two of the samples, below all of them, over which they lie lowest.
ClockLine by_trying_all_pairs(const std::vector<ClockSample>& samples) {
  double best = std::numeric_limits<double>::max();
  ClockLine line;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t j = i + 1; j < samples.size(); ++j) {
      const double slope = static_cast<double>(samples[j].offset_ns - samples[i].offset_ns) /
                           static_cast<double>(samples[j].device_ns - samples[i].device_ns);
      double sum = 0, least = 0;
      for (const ClockSample& sample : samples) {
        const double above = static_cast<double>(sample.offset_ns - samples[i].offset_ns) -
                             slope * static_cast<double>(sample.device_ns - samples[i].device_ns);
        sum += above;
        least = std::min(least, above);
      }
      if (least < -1 || sum >= best) continue;
      best = sum;
      line = {samples[i].device_ns, samples[i].offset_ns, std::lround(slope * 1e9)};
    }
  }
  return line;
}

TEST(DelayEnvelope, IsTheLowestLineBelowASampleABucket) {
  std::mt19937 random(3);
  for (int round = 0; round < 30; ++round) {
    DelayEnvelope envelope;
    std::vector<ClockSample> samples;
    for (std::int64_t i = 0; i < 64; ++i) {
      const std::int64_t t = i * kSecond + static_cast<std::int64_t>(random() % 900'000'000);
      samples.push_back({t, gained_ns(t, 30'000) + static_cast<std::int64_t>(random() % 300'000)});
    }
    envelope.reset(samples.front());
    for (const ClockSample& sample : samples) envelope.add(sample);
    const ClockLine expected = by_trying_all_pairs(samples);
    // The slope is drawn to the expected one by the little that the delays leave uncertain.
    EXPECT_NEAR(static_cast<double>(envelope.line().skew_ppb),
                static_cast<double>(expected.skew_ppb), 300);
    for (const ClockSample& sample : samples) {
      EXPECT_GE(envelope.excess_ns(sample), 0);
      EXPECT_NEAR(static_cast<double>(envelope.line().offset_at(sample.device_ns)),
                  static_cast<double>(expected.offset_at(sample.device_ns)), 10'000);
    }
  }
}

TEST(DelayEnvelope, DoesNotBelieveASlopeOfAShortTime) {
  std::mt19937 random(5);
  DelayEnvelope envelope;
  envelope.reset({0, 2'000'000});
  for (std::int64_t t = 0; t < kSecond / 2; t += 10'000'000) {
    envelope.add({t, static_cast<std::int64_t>(random() % 4'000'000)});
    EXPECT_LT(std::abs(envelope.line().skew_ppb), 10'000) << t;
    EXPECT_GT(envelope.accuracy_ns(), 100'000);
  }
}

TEST(DelayEnvelope, KeepsTheSkewWhenItBeginsAnew) {
  DelayEnvelope envelope;
  envelope.reset({0, 0});
  for (std::int64_t t = 0; t < 100 * kSecond; t += 10'000'000) {
    envelope.add({t, gained_ns(t, 80'000)});
  }
  envelope.reset({7, 5});
  EXPECT_NEAR(static_cast<double>(envelope.line().skew_ppb), 80'000, 100);
  EXPECT_EQ(envelope.line().offset_at(7), 5);
  // So it does after a gap longer than the window.
  envelope.add({2000 * kSecond, 0});
  EXPECT_NEAR(static_cast<double>(envelope.line().skew_ppb), 80'000, 200);
  EXPECT_EQ(envelope.line().offset_at(2000 * kSecond), 0);
}

TEST(DelayEnvelope, SurvivesAnySamples) {
  std::mt19937_64 random(11);
  DelayEnvelope envelope;
  envelope.reset({0, 0});
  std::int64_t t = 0;
  for (int i = 0; i < 100'000; ++i) {
    t += static_cast<std::int64_t>(random() % (random() % 100 == 0 ? 100 * kSecond : 3'000'000)) -
         1'000'000;
    envelope.add({t, static_cast<std::int64_t>(random() % 2'000'000'000)});
    ASSERT_LE(std::abs(envelope.line().skew_ppb), DelayEnvelope::kMaxSkewPpb);
  }
}

}  // namespace
}  // namespace scree
