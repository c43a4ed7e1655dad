#include "scree/motion/range_scatter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace scree {
namespace {

constexpr double kPerShot = 0.2 * std::numbers::pi / 180;

Eigen::Vector3f shot(double azimuth, double range, double up = 0) {
  const Eigen::Vector3d along(std::cos(azimuth) * std::cos(up), -std::sin(azimuth) * std::cos(up),
                              std::sin(up));
  return (range * along).cast<float>();
}

/// What is known of the points of a turn.
struct Turn {
  RangeScatter range_scatter;
  FixedVector<float> scatter;
  FixedVector<std::uint8_t> is_isolated;

  explicit Turn(std::size_t points) : scatter(points), is_isolated(points) {}
  void add(std::uint8_t laser, const Eigen::Vector3f& seen) {
    range_scatter.add(laser, seen, scatter, is_isolated);
  }
};

/// A laser's shots that follow one another; no return where the range is 0.
Turn turn_of(const std::vector<double>& ranges, double step = kPerShot) {
  Turn turn(ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (ranges[i] > 0) turn.add(3, shot(step * static_cast<double>(i), ranges[i]));
  }
  return turn;
}

std::vector<float> scatter_of(const std::vector<double>& ranges, double step = kPerShot) {
  const Turn turn = turn_of(ranges, step);
  return {turn.scatter.begin(), turn.scatter.end()};
}

std::vector<int> isolated_in(const std::vector<double>& ranges, double step = kPerShot) {
  const Turn turn = turn_of(ranges, step);
  return {turn.is_isolated.begin(), turn.is_isolated.end()};
}

double mean_of(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// The ranges of a wall 3 m ahead whose normal lies turned aside.
std::vector<double> wall(double turned_deg) {
  std::vector<double> ranges;
  for (int i = -20; i <= 20; ++i) {
    const double off = kPerShot * i - turned_deg * std::numbers::pi / 180;
    ranges.push_back(3 * std::cos(turned_deg * std::numbers::pi / 180) / std::cos(off));
  }
  return ranges;
}

TEST(RangeScatter, IsWhatTheMiddleShotIsOffTheLineBetweenTheOthers) {
  const auto at_ends = scatter_of({5, 5.03, 5});
  ASSERT_EQ(at_ends.size(), 3U);
  for (const float scatter : at_ends) EXPECT_NEAR(scatter, 0.03, 1e-5);
  // The least over the threes that a shot is in.
  const auto row = scatter_of({5, 5, 5, 5.04, 5});
  EXPECT_NEAR(row[0], 0, 1e-5);
  EXPECT_NEAR(row[2], 0, 1e-5);
  EXPECT_NEAR(row[3], 0.02, 1e-5);
  EXPECT_NEAR(row[4], 0.04, 1e-5);
}

TEST(RangeScatter, IsSmallOnAWallHoweverItStands) {
  for (const double turned : {0.0, 30.0, 60.0, -75.0}) {
    EXPECT_LT(std::ranges::max(scatter_of(wall(turned))), 0.004) << turned;
  }
}

TEST(RangeScatter, AnEdgeDoesNotCount) {
  std::vector<double> ranges(20, 9.0);
  std::fill(ranges.begin() + 8, ranges.begin() + 12, 5.0);
  EXPECT_LT(std::ranges::max(scatter_of(ranges)), 1e-5);
}

TEST(RangeScatter, IsLargeAmongBladesOfGrass) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.02);
  std::exponential_distribution<double> depth(1 / 0.2);
  std::vector<double> rock(500), grass(500);
  for (double& range : rock) range = 7 + noise(random);
  for (double& range : grass) range = 7 + noise(random) + std::min(depth(random), 0.5);
  EXPECT_LT(mean_of(scatter_of(rock)), 0.02);
  EXPECT_GT(mean_of(scatter_of(grass)), 2.5 * mean_of(scatter_of(rock)));
}

TEST(RangeScatter, ShotsWithoutNeighboursScatterMost) {
  for (const auto& ranges :
       {std::vector<double>{5}, {5, 5}, {5, 0, 0, 0, 5, 0, 0, 0, 5}, {5, 5, 0, 0, 0, 5, 5}}) {
    for (const float scatter : scatter_of(ranges)) EXPECT_EQ(scatter, RangeScatter::kMaxScatter);
  }
  const auto gap = scatter_of({5, 5, 5, 0, 0, 0, 6, 6, 6});
  EXPECT_LT(std::ranges::max(gap), 1e-5) << "threes on both sides of it";
}

TEST(RangeScatter, TakesTheSensorsSpeeds) {
  for (const double per_shot : {0.1, 0.2, 0.4}) {  // 5, 10 and 20 turns a second
    const auto scatter = scatter_of({5, 5.02, 5, 5, 5}, per_shot * std::numbers::pi / 180);
    EXPECT_NEAR(scatter[0], 0.02, 1e-5) << per_shot;
    EXPECT_NEAR(scatter[4], 0, 1e-5) << per_shot;
  }
}

TEST(RangeScatter, AGrainIsIsolated) {
  using testing::ElementsAre;
  EXPECT_THAT(isolated_in({9, 9, 2, 9, 9}), ElementsAre(0, 0, 1, 0, 0));
  EXPECT_THAT(isolated_in({0, 0, 2, 0, 0}), ElementsAre(1)) << "before the sky";
  EXPECT_THAT(isolated_in({9, 9, 2, 2.1, 9}), ElementsAre(0, 0, 0, 0, 0)) << "a post";
  EXPECT_THAT(isolated_in({9, 2, 9, 9, 9, 2.2, 9}), ElementsAre(0, 0, 0, 0, 0, 0, 0)) << "grass";
  EXPECT_THAT(isolated_in({9, 2, 9, 9, 9, 9, 2, 9}), ElementsAre(0, 1, 0, 0, 0, 0, 1, 0));
  EXPECT_THAT(isolated_in({9, 2, 9, 2.5, 9}), ElementsAre(0, 1, 0, 1, 0));
  EXPECT_THAT(isolated_in({2, 0, 0, 2}, 2 * kPerShot), ElementsAre(1, 1)) << "20 turns a second";
  EXPECT_THAT(isolated_in({2, 0, 2}, 2 * kPerShot), ElementsAre(0, 0));
}

TEST(RangeScatter, ThinDustIsMostlyIsolatedAndGrassIsNot) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> depth(0, 0.5), chance(0, 1);
  const auto share = [&](double stopped) {
    std::vector<double> ranges(5000, 9.0);
    for (double& range : ranges) {
      if (chance(random) < stopped) range = 4 + depth(random);
    }
    const auto isolated = isolated_in(ranges);
    double near = 0, alone = 0;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      if (ranges[i] > 5) continue;
      ++near;
      alone += isolated[i];
    }
    return alone / near;
  };
  EXPECT_GT(share(0.02), 0.8);
  EXPECT_LT(share(0.5), 0.05);
}

TEST(RangeScatter, KeepsLasersApart) {
  Turn turn(32 * 16);
  for (int i = 0; i < 32; ++i) {
    for (std::uint8_t laser = 0; laser < 16; ++laser) {
      turn.add(laser, shot(kPerShot * i, 4 + laser, 0.035 * (laser - 8)));
    }
  }
  EXPECT_LT(std::ranges::max(turn.scatter), 1e-4);
  EXPECT_EQ(std::ranges::max(turn.is_isolated), 0);
}

// With dual returns the second return of a shot follows the first.
TEST(RangeScatter, TwoReturnsOfAShotAreNoNeighbours) {
  Turn turn(40);
  for (int i = 0; i < 20; ++i) {
    turn.add(3, shot(kPerShot * i, 5));
    turn.add(3, shot(kPerShot * i, 8));
  }
  for (std::size_t i = 0; i < turn.scatter.size(); ++i) {
    EXPECT_NEAR(turn.scatter[i], i % 2 == 0 ? 0 : RangeScatter::kMaxScatter, 1e-5) << i;
  }
}

TEST(RangeScatter, TakesAnythingAndNoMoreThanFits) {
  Turn turn(100);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const Eigen::Vector3f odd[] = {{0, 0, 0}, {kNan, 0, 1}, {kInfinity, 1, 0}, {1e30F, 1e30F, 0}};
  for (int i = 0; i < 200; ++i) {
    turn.add(static_cast<std::uint8_t>(i), i % 3 == 0 ? odd[i % 4] : shot(kPerShot * i, 5));
  }
  EXPECT_EQ(turn.scatter.size(), 100U);
  EXPECT_EQ(turn.is_isolated.size(), 100U);
  for (const float each : turn.scatter) {
    EXPECT_GE(each, 0);
    EXPECT_LE(each, RangeScatter::kMaxScatter);
  }
}

}  // namespace
}  // namespace scree
