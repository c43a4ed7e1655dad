#include "scree/core/latency_histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace scree {
namespace {

std::int64_t exact_quantile(std::vector<std::int64_t> values, double share) {
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(
      std::max(1.0, std::ceil(share * static_cast<double>(values.size()))));
  return values[rank - 1];
}

TEST(LatencyHistogram, EmptyIsZero) {
  const LatencyHistogram histogram;
  EXPECT_EQ(histogram.count(), 0U);
  EXPECT_EQ(histogram.quantile_ns(0.5), 0);
  EXPECT_EQ(histogram.max_ns(), 0);
}

TEST(LatencyHistogram, QuantilesAreAtMostAThirtySecondAboveTheExactOnes) {
  std::mt19937_64 random(7);
  std::lognormal_distribution<double> milliseconds(1.0, 2.5);
  std::vector<std::int64_t> values;
  LatencyHistogram histogram;
  for (int i = 0; i < 20000; ++i) {
    values.push_back(static_cast<std::int64_t>(1e6 * milliseconds(random)));
    histogram.record(values.back());
    if (i != 0 && i != 99 && i != 19999) continue;
    for (const double share : {0.0, 0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const std::int64_t exact = exact_quantile(values, share);
      EXPECT_GE(histogram.quantile_ns(share), exact) << share;
      EXPECT_LE(histogram.quantile_ns(share), exact + exact / 32 + 1) << share;
    }
    EXPECT_EQ(histogram.max_ns(), exact_quantile(values, 1.0));
  }
  EXPECT_EQ(histogram.count(), values.size());
}

TEST(LatencyHistogram, SmallDurationsAreExact) {
  for (std::int64_t value = 0; value < 64; ++value) {
    LatencyHistogram histogram;
    histogram.record(value);
    histogram.record(1000);
    EXPECT_EQ(histogram.quantile_ns(0.5), value);
  }
}

TEST(LatencyHistogram, TakesEveryDuration) {
  LatencyHistogram histogram;
  histogram.record(-5);
  EXPECT_EQ(histogram.quantile_ns(1.0), 0);
  histogram.record(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(histogram.quantile_ns(1.0), std::numeric_limits<std::int64_t>::max());
}

}  // namespace
}  // namespace scree
