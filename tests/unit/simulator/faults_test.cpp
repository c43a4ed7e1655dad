#include "simulator/faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace scree {
namespace {

TEST(Faults, GapsKeepApartFromEachOtherAndFromTheEnds) {
  int imu_first = 0;
  for (const double seconds : {kLeastFaultySeconds, 20.0, 300.0}) {
    double earliest = seconds, latest = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const Faults faults = draw_faults(seconds, seed);
      EXPECT_EQ(faults.packet_loss, 0.01);
      EXPECT_NEAR(faults.imu_corruption * 73, 0.01, 1e-9) << "messages have 73 bytes";
      EXPECT_EQ(faults.imu_gap.seconds, 2);
      EXPECT_EQ(faults.encoder_gap.seconds, 3);
      const bool is_imu_first = faults.imu_gap.start < faults.encoder_gap.start;
      imu_first += is_imu_first ? 1 : 0;
      const Gap& first = is_imu_first ? faults.imu_gap : faults.encoder_gap;
      const Gap& second = is_imu_first ? faults.encoder_gap : faults.imu_gap;
      EXPECT_GE(first.start, 3);
      EXPECT_GE(second.start - first.end(), 2 - 1e-9);
      EXPECT_LE(second.end(), seconds - 2 + 1e-9);
      earliest = std::min(earliest, first.start);
      latest = std::max(latest, second.end());
    }
    EXPECT_LT(earliest, 3 + 0.1 * seconds);
    EXPECT_GT(latest, 0.9 * (seconds - 2));
  }
  EXPECT_GT(imu_first, 200);
  EXPECT_LT(imu_first, 400);
}

TEST(Faults, TheSameSeedGivesTheSame) {
  EXPECT_EQ(draw_faults(20, 5).imu_gap.start, draw_faults(20, 5).imu_gap.start);
  EXPECT_NE(draw_faults(20, 5).imu_gap.start, draw_faults(20, 6).imu_gap.start);
}

TEST(Gap, HoldsItsBeginButNotItsEnd) {
  const Gap gap{2, 1};
  EXPECT_FALSE(gap.holds(1.999));
  EXPECT_TRUE(gap.holds(2));
  EXPECT_TRUE(gap.holds(2.999));
  EXPECT_FALSE(gap.holds(3));
  EXPECT_FALSE(Gap().holds(0));
}

}  // namespace
}  // namespace scree
