#include "scree/app/motion_wait.hpp"

#include <gtest/gtest.h>

#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

constexpr std::int64_t kStart = 1'000 * kSecond;

class MotionWaitTest : public testing::Test {
protected:
  void put_imu(std::int64_t t_ns) {
    ImuSample sample;
    sample.has_orientation = true;
    sample.t_ns = t_ns;
    sensors_.put(sample);
  }
  /// Times are milliseconds after the start.
  bool is_over(std::int64_t end_ms, std::int64_t arrival_ms, std::int64_t now_ms) {
    return wait_.is_over(kStart + end_ms * kMillisecond, kStart + arrival_ms * kMillisecond,
                         kStart + now_ms * kMillisecond);
  }

  SyncBuffer sensors_;
  MotionWait wait_{sensors_, 0.05};
};

TEST_F(MotionWaitTest, WithoutASensorThereIsNothingToWaitFor) {
  EXPECT_TRUE(is_over(0, 2, 2));
  EXPECT_EQ(wait_.not_covered(), 0U);
}

TEST_F(MotionWaitTest, EndsWithTheSampleThatCoversTheSweep) {
  put_imu(kStart - 10 * kMillisecond);
  EXPECT_FALSE(is_over(0, 2, 2));
  put_imu(kStart);
  EXPECT_TRUE(is_over(0, 2, 4));
  EXPECT_EQ(wait_.not_covered(), 0U);
}

TEST_F(MotionWaitTest, EndsAtTheLimitAndCountsTheSweep) {
  put_imu(kStart - 10 * kMillisecond);
  EXPECT_FALSE(is_over(0, 2, 51));
  EXPECT_EQ(wait_.not_covered(), 0U);
  EXPECT_TRUE(is_over(0, 2, 52));
  EXPECT_EQ(wait_.not_covered(), 1U);
  wait_.set_limit(0.1);
  EXPECT_FALSE(is_over(0, 2, 101));
  EXPECT_TRUE(is_over(0, 2, 102));
  EXPECT_EQ(wait_.not_covered(), 2U);
}

TEST_F(MotionWaitTest, ASensorThatIsSilentForLongIsNotWaitedFor) {
  put_imu(kStart);
  EXPECT_TRUE(is_over(8'000, 8'002, 8'002));
  EXPECT_EQ(wait_.not_covered(), 0U);
}

}  // namespace
}  // namespace scree
