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
  space.add_hit(point, 7);
  space.add_hit(other, 7);
  EXPECT_EQ(space.hit_ratio(point), 0.25F);
  EXPECT_EQ(space.hit_ratio(other), 1);
  EXPECT_EQ(space.last_miss(point), 7U);
  EXPECT_EQ(space.last_miss(other), 0U) << "none went through";
  space.add_hit(point + Eigen::Vector3f(32, 0, 0), 8);
  EXPECT_EQ(space.hit_ratio(point), 1) << "forgotten";
}

TEST(FreeSpace, ASmallShareIsKeptOverMillionsOfBeams) {
  FreeSpace space;
  const Eigen::Vector3f point(1, 1, 0.1F);
  for (int i = 0; i < 1'000'000; ++i) {
    if (i % 20 == 0) {
      space.add_hit(point, 1);
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
  for (int i = 0; i < 100; ++i) space.add_hit(point, 1);
  EXPECT_GT(space.hit_ratio(point), 0.045F);
}

constexpr float kCell = FreeSpace::kCell;
const Eigen::Vector3f kHere(1.1F, 1.1F, 0.6F), kUp(0, 0, kCell);

/// Beams go through a place in the sweeps from `first` on.
void pass(FreeSpace& space, const Eigen::Vector3f& point, std::uint32_t first, int sweeps) {
  for (int i = 0; i < sweeps; ++i) space.add_misses(point, first + static_cast<unsigned>(i), 4);
}

TEST(FreeSpace, APlaceIsClearAfterSeveralSweepsWentThrough) {
  FreeSpace space;
  EXPECT_FALSE(space.is_clear(kHere)) << "unknown";
  pass(space, kHere, 2, 3);
  EXPECT_FALSE(space.is_clear(kHere));
  pass(space, kHere, 5, 1);
  EXPECT_TRUE(space.is_clear(kHere));
  space.clear();
  EXPECT_FALSE(space.is_clear(kHere));
}

TEST(FreeSpace, BesideSomethingNothingIsClear) {
  FreeSpace space;
  space.add_hit(kHere + kUp, 1);
  pass(space, kHere, 3, 40);
  EXPECT_FALSE(space.is_clear(kHere));
  pass(space, kHere - kUp, 3, 40);
  EXPECT_TRUE(space.is_clear(kHere - kUp)) << "two cells away";
}

TEST(FreeSpace, AClearPlaceStaysSoWhileSomethingPassesAndNotWhenItStays) {
  FreeSpace space;
  pass(space, kHere, 2, 10);
  pass(space, kHere + kUp, 2, 10);
  for (std::uint32_t sweep = 12; sweep < 24; ++sweep) space.add_hit(kHere, sweep);
  EXPECT_TRUE(space.is_clear(kHere));
  EXPECT_TRUE(space.is_clear(kHere + kUp));
  pass(space, kHere, 26, 5);
  for (std::uint32_t sweep = 31; sweep < 50; ++sweep) space.add_hit(kHere, sweep);
  EXPECT_TRUE(space.is_clear(kHere)) << "it left between";
  space.add_hit(kHere, 50);
  EXPECT_FALSE(space.is_clear(kHere));
  EXPECT_FALSE(space.is_clear(kHere + kUp)) << "what stays may reach into the next cell";
}

TEST(FreeSpace, TellsWhatIsThereFromWhatHasLeft) {
  using Presence = FreeSpace::Presence;
  FreeSpace space;
  EXPECT_EQ(space.presence(kHere, 1), Presence::unknown);
  for (std::uint32_t sweep = 1; sweep < 10; ++sweep) space.add_hit(kHere, sweep);
  EXPECT_EQ(space.presence(kHere, 11), Presence::there);
  EXPECT_EQ(space.presence(kHere, 12), Presence::unknown) << "out of sight";
  pass(space, kHere, 11, 2);
  EXPECT_EQ(space.presence(kHere, 12), Presence::gone);
  EXPECT_TRUE(space.is_seen_through(kHere, 13));
  EXPECT_FALSE(space.is_seen_through(kHere, 14));
}

}  // namespace
}  // namespace scree
