#include "simulator/tufts.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

TEST(Tufts, LightPassesAsOftenAsTheirDensitySays) {
  const Tufts tufts({{{0.1, 0, 0}, 0.3, 0.4, 2.5}}, 10);
  const Eigen::Vector3d origin(-3, 0, 1e-6);
  Random random(1);
  constexpr int kBeams = 20000;
  int hits = 0;
  double depths = 0;
  for (int i = 0; i < kBeams; ++i) {
    const auto range = tufts.cast(origin, {1, 0, 0}, 20, random);
    if (!range) continue;
    ++hits;
    EXPECT_GE(*range, 2.8 - 1e-6);
    EXPECT_LE(*range, 3.4 + 1e-6);
    depths += *range - 2.8;
  }
  const double passes = std::exp(-2.5 * 0.6);  // Beer's law over the diameter
  EXPECT_NEAR(static_cast<double>(hits) / kBeams, 1 - passes, 0.01);
  const double mean_depth = 1 / 2.5 - 0.6 * passes / (1 - passes);  // of those that met a blade
  EXPECT_NEAR(depths / hits, mean_depth, 0.005);
}

TEST(Tufts, BeamsBesideAboveAndShortOfThemPass) {
  const Tufts tufts({{{1, 1, 0}, 0.3, 0.4, 1000}}, 10);
  Random random(1);
  EXPECT_FALSE(tufts.cast({1, -3, 0.45}, {0, 1, 0}, 20, random));
  EXPECT_FALSE(tufts.cast({1.31, -3, 0.1}, {0, 1, 0}, 20, random));
  EXPECT_FALSE(tufts.cast({1, -3, 0.1}, {0, 1, 0}, 3.5, random));
  EXPECT_FALSE(tufts.cast({1, -3, 0.1}, {0, -1, 0}, 20, random));
  const auto straight_down = tufts.cast({1, 1, 2}, {0, 0, -1}, 20, random);
  ASSERT_TRUE(straight_down);
  EXPECT_NEAR(*straight_down, 1.6, 0.02);
}

TEST(Tufts, TheNearestOfManyIsMet) {
  std::vector<Tuft> many;
  for (double x = -4; x <= 4; x += 0.45) many.push_back({{x, 0.05, 0}, 0.2, 0.3, 1e5});
  const Tufts tufts(many, 10);
  Random random(1);
  const auto range = tufts.cast({-4.9, 0, 0.1}, {1, 0, 0}, 20, random);
  ASSERT_TRUE(range);
  EXPECT_LT(*range, 0.9);
  EXPECT_GT(*range, 0.7);
}

TEST(Tufts, KnowWhichCoversAPlace) {
  const Tufts tufts({{{1, 1, 0}, 0.3, 0.4, 1}}, 10);
  EXPECT_NE(tufts.at(1.2, 1.1), nullptr);
  EXPECT_EQ(tufts.at(1.3, 1.3), nullptr);
  EXPECT_EQ(Tufts().at(0, 0), nullptr);
}

}  // namespace
}  // namespace scree
