#include "scree/terrain/free_space.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <tuple>

namespace scree {
namespace {

using Cell = std::tuple<int, int, int>;

Cell cell_of(const Eigen::Vector3f& place) {
  const auto cell = [](float value) {
    return static_cast<int>(std::floor(static_cast<double>(value) / FreeSpace::kCell));
  };
  return {cell(place.x()), cell(place.y()), cell(place.z())};
}

// Within half the box a plain map of cells gives the same answers, wherever the robot is.
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
      const Eigen::Vector3f place = somewhere();
      space.pass(place, sweep, 1);
      reference[cell_of(place)] = sweep;
    }
    for (int i = 0; i < 20'000; ++i) {
      const Eigen::Vector3f place = somewhere();
      const auto found = reference.find(cell_of(place));
      const std::uint32_t expected = found == reference.end() ? 0 : found->second;
      ASSERT_EQ(space.last_passed(place), expected) << place.transpose();
    }
    space.clear();
    EXPECT_EQ(space.last_passed(somewhere()), 0U);
  }
}

TEST(FreeSpace, APlaceTakesOverTheMemoryOfOneFarAway) {
  FreeSpace space;
  const Eigen::Vector3f here(1, 1, 0.1F), far_away = here + Eigen::Vector3f(32, 0, 0);
  space.pass(here, 5, 1);
  EXPECT_EQ(space.last_passed(far_away), 0U);
  space.pass(far_away, 6, 1);
  EXPECT_EQ(space.last_passed(far_away), 6U);
  EXPECT_EQ(space.last_passed(here), 0U);
}

TEST(FreeSpace, CountsTheBeamsThatEnd) {
  FreeSpace space;
  const Eigen::Vector3f place(1, 1, 0.1F), other(1, 1, 0.4F);
  EXPECT_EQ(space.ended_share(place), 1) << "no beam came there";
  space.pass(place, 7, 3);
  EXPECT_EQ(space.ended_share(place), 0);
  space.end(place);
  space.end(other);
  EXPECT_EQ(space.ended_share(place), 0.25F);
  EXPECT_EQ(space.ended_share(other), 1);
  EXPECT_EQ(space.last_passed(place), 7U);
  EXPECT_EQ(space.last_passed(other), 0U) << "none went through";
  space.end(place + Eigen::Vector3f(32, 0, 0));
  EXPECT_EQ(space.ended_share(place), 1) << "forgotten";
}

TEST(FreeSpace, ASmallShareIsKeptOverMillionsOfBeams) {
  FreeSpace space;
  const Eigen::Vector3f place(1, 1, 0.1F);
  for (int i = 0; i < 1'000'000; ++i) {
    if (i % 20 == 0) {
      space.end(place);
    } else {
      space.pass(place, 1, 1);
    }
    if (i > 1000) {
      ASSERT_NEAR(space.ended_share(place), 0.05, 0.002);
    }
  }
}

TEST(FreeSpace, WhatComesToAPlaceLongFreeShowsAfterAHundredBeams) {
  FreeSpace space;
  const Eigen::Vector3f place(1, 1, 0.1F);
  for (int i = 0; i < 1'000'000; ++i) space.pass(place, 1, 4);
  for (int i = 0; i < 100; ++i) space.end(place);
  EXPECT_GT(space.ended_share(place), 0.045F);
}

}  // namespace
}  // namespace scree
