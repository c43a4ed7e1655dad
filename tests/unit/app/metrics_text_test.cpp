#include "app/metrics_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <regex>
#include <set>
#include <sstream>

namespace scree {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

health_t example_health() {
  health_t health{};
  health.stamp_ns = 1'600'000'000'500'000'000;
  health.version = "1.0 \"x\"\n\\";
  health.state = health_t::OK;
  health.stop = 1;
  health.lidar.state = sensor_health_t::OK;
  health.lidar.rate = 753.5;
  health.lidar.messages = 12345678901;
  health.imu.refused = {3, 4};
  health.latency.p99_ms = 61.5;
  health.position_deviation = std::numeric_limits<double>::quiet_NaN();
  health.lists_published = 99;
  return health;
}

TEST(MetricsText, SaysWhatHealthSays) {
  const std::string text = metrics_text(example_health());
  EXPECT_THAT(text, HasSubstr("\nscree_blind 0\n"));
  EXPECT_THAT(text, HasSubstr("\nscree_stop 1\n"));
  EXPECT_THAT(text, HasSubstr("\nscree_sensor_rate_hertz{sensor=\"lidar\"} 753.5\n"));
  EXPECT_THAT(text, HasSubstr("\nscree_sensor_messages_total{sensor=\"lidar\"} 12345678901\n"));
  EXPECT_THAT(text, HasSubstr("\nscree_sensor_refused_total{sensor=\"imu\"} 7\n"));
  EXPECT_THAT(text, HasSubstr("\nscree_latency_seconds{quantile=\"0.99\"} 0.0615\n"));
  EXPECT_THAT(text, HasSubstr("\nscree_lists_published_total 99\n"));
}

TEST(MetricsText, WhatIsNoNumberIsLeftOut) {
  EXPECT_THAT(metrics_text(example_health()), Not(HasSubstr("\nscree_position_deviation_meters ")));
}

/// The exposition format: each family's head once, its samples behind it, labels escaped.
TEST(MetricsText, IsOfTheFormatThatPrometheusReads) {
  std::istringstream lines(metrics_text(example_health()));
  const std::regex help("# HELP (scree_[a-z0-9_]+) [^\\\\]+"),
      type("# TYPE (scree_[a-z0-9_]+) (counter|gauge|summary)"),
      sample("(scree_[a-z0-9_]+)(\\{[a-z_]+=\"([^\"\\\\]|\\\\[\\\\\"n])*\"\\})? [-+.0-9e]+");
  std::set<std::string> families, seen;
  std::string family;
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, help)) {
      family = match[1];
      EXPECT_TRUE(families.insert(family).second) << line;
    } else if (std::regex_match(line, match, type)) {
      EXPECT_EQ(match[1], family);
      EXPECT_EQ(match[2] == "counter", family.ends_with("_total")) << line;
    } else {
      ASSERT_TRUE(std::regex_match(line, match, sample)) << line;
      EXPECT_EQ(match[1], family);
      EXPECT_TRUE(seen.insert(std::string(match[1]) + std::string(match[2])).second) << line;
    }
  }
  EXPECT_GT(families.size(), 25U);
}

}  // namespace
}  // namespace scree
