#include "scree/terrain/free_space.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <tuple>

namespace scree {
namespace {

using Cell = std::tuple<int, int, int>;

Cell cell_of(const Eigen::Vector3f& point) {
  const auto cell = [](float value) {
    return static_cast<int>(std::floor(static_cast<double>(value) / FreeSpace::kCell));
  };
  return {cell(point.x()), cell(point.y()), cell(point.z())};
}

// Within half the grid a plain map of cells gives the same answers, wherever the robot is.
TEST(FreeSpace, RemembersWhatWasPassedLast) {
  for (const float far : {0.0F, -3.1F, 500.0F, 8191.9F, -8192.1F, 50'000.0F}) {
    FreeSpace space;
    std::map<Cell, std::uint32_t> reference;
    std::mt19937 random(17);
    std::uniform_real_distribution<float> wide(-15, 15), high(-3, 3);
    const auto somewhere = [&] {
      return Eigen::Vector3f(far + wide(random), -far + wide(random), high(random));
    };
    for (std::uint32_t sweep = 1; sweep <= 20'000; ++sweep) {
      const Eigen::Vector3f point = somewhere();
      space.add_misses(point, sweep, 1);
      reference[cell_of(point)] = sweep;
    }
    for (int i = 0; i < 20'000; ++i) {
      const Eigen::Vector3f point = somewhere();
      const auto found = reference.find(cell_of(point));
      const std::uint32_t expected = found == reference.end() ? 0 : found->second;
      ASSERT_EQ(space.last_miss(point), expected) << point.transpose();
    }
    space.clear();
    EXPECT_EQ(space.last_miss(somewhere()), 0U);
  }
}

TEST(FreeSpace, APlaceTakesOverTheMemoryOfOneFarAway) {
  FreeSpace space;
  const Eigen::Vector3f here(1, 1, 0.1F), far_away = here + Eigen::Vector3f(32, 0, 0);
  space.add_misses(here, 5, 1);
  EXPECT_EQ(space.last_miss(far_away), 0U);
  space.add_misses(far_away, 6, 1);
  EXPECT_EQ(space.last_miss(far_away), 6U);
  EXPECT_EQ(space.last_miss(here), 0U);
}

TEST(FreeSpace, CountsTheBeamsThatEnd) {
  FreeSpace space;
  const Eigen::Vector3f point(1, 1, 0.1F), other(1, 1, 0.4F);
  EXPECT_EQ(space.hit_ratio(point), 1) << "no beam came there";
  space.add_misses(point, 7, 3);
  EXPECT_EQ(space.hit_ratio(point), 0);
  space.add_hit(point);
  space.add_hit(other);
  EXPECT_EQ(space.hit_ratio(point), 0.25F);
  EXPECT_EQ(space.hit_ratio(other), 1);
  EXPECT_EQ(space.last_miss(point), 7U);
  EXPECT_EQ(space.last_miss(other), 0U) << "none went through";
  space.add_hit(point + Eigen::Vector3f(32, 0, 0));
  EXPECT_EQ(space.hit_ratio(point), 1) << "forgotten";
}

TEST(FreeSpace, ASmallShareIsKeptOverMillionsOfBeams) {
  FreeSpace space;
  const Eigen::Vector3f point(1, 1, 0.1F);
  for (int i = 0; i < 1'000'000; ++i) {
    if (i % 20 == 0) {
      space.add_hit(point);
    } else {
      space.add_misses(point, 1, 1);
    }
    if (i > 1000) {
      ASSERT_NEAR(space.hit_ratio(point), 0.05, 0.002);
    }
  }
}

TEST(FreeSpace, WhatComesToAPlaceLongFreeShowsAfterAHundredBeams) {
  FreeSpace space;
  const Eigen::Vector3f point(1, 1, 0.1F);
  for (int i = 0; i < 1'000'000; ++i) space.add_misses(point, 1, 4);
  for (int i = 0; i < 100; ++i) space.add_hit(point);
  EXPECT_GT(space.hit_ratio(point), 0.045F);
}

}  // namespace
}  // namespace scree
