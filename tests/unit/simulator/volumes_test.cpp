#include "simulator/volumes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

TEST(Volumes, LightPassesAsOftenAsTheirDensitySays) {
  const Volumes tufts({Volume::tuft({0.1, 0, 0}, 0.3, 0.4, 2.5)}, 10);
  const Eigen::Vector3d origin(-3, 0, 1e-6);
  Random random(1);
  constexpr int kBeams = 20000;
  int hits = 0;
  double depths = 0;
  for (int i = 0; i < kBeams; ++i) {
    const auto range = tufts.cast(origin, {1, 0, 0}, 20, random);
    if (!range) continue;
    ++hits;
    EXPECT_GE(range->range, 2.8 - 1e-6);
    EXPECT_LE(range->range, 3.4 + 1e-6);
    depths += range->range - 2.8;
  }
  const double passes = std::exp(-2.5 * 0.6);  // Beer's law over the diameter
  EXPECT_NEAR(static_cast<double>(hits) / kBeams, 1 - passes, 0.01);
  const double mean_depth = 1 / 2.5 - 0.6 * passes / (1 - passes);  // of those that met a blade
  EXPECT_NEAR(depths / hits, mean_depth, 0.005);
}

TEST(Volumes, BeamsBesideAboveAndShortOfThemPass) {
  const Volumes tufts({Volume::tuft({1, 1, 0}, 0.3, 0.4, 1000)}, 10);
  Random random(1);
  EXPECT_FALSE(tufts.cast({1, -3, 0.45}, {0, 1, 0}, 20, random));
  EXPECT_FALSE(tufts.cast({1.31, -3, 0.1}, {0, 1, 0}, 20, random));
  EXPECT_FALSE(tufts.cast({1, -3, 0.1}, {0, 1, 0}, 3.5, random));
  EXPECT_FALSE(tufts.cast({1, -3, 0.1}, {0, -1, 0}, 20, random));
  const auto straight_down = tufts.cast({1, 1, 2}, {0, 0, -1}, 20, random);
  ASSERT_TRUE(straight_down);
  EXPECT_NEAR(straight_down->range, 1.6, 0.02);
}

TEST(Volumes, TheNearestOfManyIsMet) {
  std::vector<Volume> many;
  for (double x = -4; x <= 4; x += 0.45) many.push_back(Volume::tuft({x, 0.05, 0}, 0.2, 0.3, 1e5));
  const Volumes tufts(many, 10);
  Random random(1);
  const auto range = tufts.cast({-4.9, 0, 0.1}, {1, 0, 0}, 20, random);
  ASSERT_TRUE(range);
  EXPECT_LT(range->range, 0.9);
  EXPECT_GT(range->range, 0.7);
}

TEST(Volumes, KnowWhichCoversAPlace) {
  const Volumes tufts({Volume::tuft({1, 1, 0}, 0.3, 0.4, 1)}, 10);
  EXPECT_NE(tufts.at(1.2, 1.1), nullptr);
  EXPECT_EQ(tufts.at(1.3, 1.3), nullptr);
  EXPECT_EQ(Volumes().at(0, 0), nullptr);
}

TEST(Volumes, ARodIsMetAllAroundAndFacesTheBeam) {
  const Volumes rods({Volume::rod({1, -1, 0.5}, {1, 1, 0.5}, 0.1)}, 10);
  Random random(1);
  const Eigen::Vector3d origin(-2, 0.3, 0.5);
  const auto hit = rods.cast(origin, {1, 0, 0}, 20, random);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->range, 2.9, 1e-9);
  EXPECT_TRUE(hit->volume->normal(origin + Eigen::Vector3d(2.9, 0, 0))
                  .isApprox(Eigen::Vector3d(-1, 0, 0), 1e-6));
  EXPECT_FALSE(rods.cast({-2, 0.3, 0.65}, {1, 0, 0}, 20, random)) << "above";
  EXPECT_FALSE(rods.cast({-2, 0.3, 0.3}, {1, 0, 0}, 20, random)) << "below";
  EXPECT_FALSE(rods.cast({-2, 1.2, 0.5}, {1, 0, 0}, 20, random)) << "beside its end";
  const auto along = rods.cast({1.05, -3, 0.5}, {0, 1, 0}, 20, random);
  ASSERT_TRUE(along);
  EXPECT_NEAR(along->range, 2, 1e-9);
}

TEST(Volumes, ATurnedBoxIsMetOnTheFaceThatLooksBack) {
  const Volumes boxes({Volume::block({2, 0, 0.5}, {1, 0.2, 0.5}, M_PI / 2)}, 10);
  Random random(1);
  const auto hit = boxes.cast({-2, 0.7, 0.5}, {1, 0, 0}, 20, random);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->range, 3.8, 1e-9);
  EXPECT_TRUE(hit->volume->normal({1.8, 0.7, 0.5}).isApprox(Eigen::Vector3d(-1, 0, 0), 1e-6));
  EXPECT_FALSE(boxes.cast({-2, 1.1, 0.5}, {1, 0, 0}, 20, random));
  EXPECT_TRUE(boxes.is_near(2, 1.3, 0.5));
  EXPECT_FALSE(boxes.is_near(4, 3, 0.5));
}

TEST(Volumes, BeamsPassBelowWhatHangsAboveTheGround) {
  const Volumes crowns({Volume::tuft({1, 0, 4}, 2, 1, 1e4)}, 10);
  Random random(1);
  EXPECT_FALSE(crowns.cast({-3, 0, 1}, {1, 0, 0}, 20, random));
  EXPECT_TRUE(crowns.cast({-3, 0, 1}, Eigen::Vector3d(1, 0, 0.8).normalized(), 20, random));
}

}  // namespace
}  // namespace scree
