#include "scree/detect/pieces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace scree {
namespace {

Obstacle box(double x, double y, double length, double width, std::uint32_t points,
             ObstacleKind kind = ObstacleKind::positive) {
  static std::int64_t next_id = 1;
  Obstacle obstacle;
  obstacle.id = next_id++;
  obstacle.kind = kind;
  obstacle.center = {x, y, 0.2};
  obstacle.extent = {length, width, 0.4};
  obstacle.height = kind == ObstacleKind::positive ? 0.4 : -0.4;
  obstacle.confidence = 0.9F;
  obstacle.points = points;
  return obstacle;
}

FixedVector<Obstacle> joined(const std::vector<Obstacle>& obstacles) {
  FixedVector<Obstacle> list(64);
  for (const Obstacle& obstacle : obstacles) list.push_back(obstacle);
  Pieces(64).join(list);
  return list;
}

std::vector<Eigen::Vector3d> outline(const Obstacle& obstacle) {
  std::vector<Eigen::Vector3d> corners;
  const Eigen::AngleAxisd turn(obstacle.yaw, Eigen::Vector3d::UnitZ());
  for (const double along : {-0.5, 0.5}) {
    for (const double across : {-0.5, 0.5}) {
      corners.push_back(obstacle.center + turn * Eigen::Vector3d(along * obstacle.extent.x(),
                                                                 across * obstacle.extent.y(), 0));
    }
  }
  return corners;
}

TEST(Pieces, WhatIsMostlyOneThingStaysOne) {
  const Obstacle rock = box(5, 0, 1, 1, 100);
  Obstacle sliver = box(5.75, 0, 0.1, 0.1, 10);
  const Obstacle away = [&] {
    Obstacle moved = sliver;
    moved.center.x() = 6.5;
    return moved;
  }();
  Pieces pieces(64);
  const auto count = [&](const Obstacle& second) {
    FixedVector<Obstacle> list(64);
    list.push_back(rock);
    list.push_back(second);
    pieces.join(list);
    return list.size();
  };
  EXPECT_EQ(count(away), 2U);
  EXPECT_EQ(count(sliver), 1U);
  EXPECT_EQ(count(away), 2U) << "one list says little";
  for (const bool is_away : {false, false, true, false, true, false, false, true, true}) {
    EXPECT_EQ(count(is_away ? away : sliver), 1U);
  }
  for (int i = 0; i < 4; ++i) count(away);
  EXPECT_EQ(count(away), 2U);
  // Never what is of another kind by now.
  for (int i = 0; i < 4; ++i) EXPECT_EQ(count(sliver), 1U);
  sliver.kind = ObstacleKind::negative;
  EXPECT_EQ(count(sliver), 2U);
}

TEST(DistanceToBox, IsMeasuredFromItsEdgesInThePlane) {
  Obstacle rock = box(1, 2, 2, 1, 100);
  rock.yaw = std::numbers::pi / 2;
  EXPECT_EQ(distance_to_box(rock, {1, 2, 9}), 0);
  EXPECT_EQ(distance_to_box(rock, {1.4, 2.9, 0}), 0);
  EXPECT_NEAR(distance_to_box(rock, {2.5, 2, 0}), 1, 1e-12);
  EXPECT_NEAR(distance_to_box(rock, {1, 3.5, 0}), 0.5, 1e-12);
  EXPECT_NEAR(distance_to_box(rock, {1.8, 3.4, 0}), 0.5, 1e-12) << "from a corner";
}

TEST(JoinPieces, ASliverBesideARockBelongsToIt) {
  const Obstacle sliver = box(3.9, 1, 0.6, 0.1, 12);
  const Obstacle rock = box(3, 1, 1, 0.8, 200);
  const auto list = joined({sliver, rock});
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].id, std::min(sliver.id, rock.id)) << "the id that it had first";
  EXPECT_EQ(list[0].points, 212U);
  EXPECT_NEAR(list[0].extent.x(), 1.7, 1e-9) << "from 2.5 to 4.2";
  EXPECT_NEAR(list[0].center.x(), 3.35, 1e-9);
  EXPECT_NEAR(list[0].extent.y(), 0.8, 1e-9);
  EXPECT_NEAR(list[0].extent.z(), 0.4, 1e-9);
}

TEST(JoinPieces, RocksBesideOneAnotherStayTwo) {
  EXPECT_EQ(joined({box(3, 1, 0.6, 0.5, 100), box(4, 1, 0.6, 0.5, 90)}).size(), 2U);
  EXPECT_EQ(joined({box(3, 1, 1, 0.8, 200), box(4.5, 1, 0.6, 0.1, 12)}).size(), 2U)
      << "a sliver 0.7 m off";
  EXPECT_EQ(joined({box(3, 1, 2, 1.5, 2000), box(4.25, 1, 0.45, 0.3, 35)}).size(), 2U)
      << "a small one at the foot of a large one";
  EXPECT_EQ(joined({box(3, 1, 2, 1.5, 2000), box(3.9, 1, 0.45, 0.3, 35)}).size(), 1U)
      << "a part of it";
}

TEST(JoinPieces, HolesBesideOneAnotherAreOne) {
  constexpr auto kHole = ObstacleKind::negative;
  EXPECT_EQ(joined({box(3, 1, 1, 0.5, 100, kHole), box(4.2, 1, 0.6, 0.5, 90, kHole)}).size(), 1U);
  EXPECT_EQ(joined({box(3, 1, 1, 0.5, 100, kHole), box(4.5, 1, 0.6, 0.5, 90, kHole)}).size(), 2U);
  EXPECT_EQ(joined({box(3, 1, 1, 0.5, 100), box(3.6, 1, 0.6, 0.1, 9, kHole)}).size(), 2U)
      << "a hole at a rock's foot";
}

TEST(JoinPieces, ADitchAndAPitBesideItsEndStayTwo) {
  constexpr auto kHole = ObstacleKind::negative;
  EXPECT_EQ(joined({box(0, 0, 4, 1, 300, kHole), box(1.5, 1.6, 1.5, 1.5, 90, kHole)}).size(), 2U)
      << "one box of both would hold 3 square metres of ground";
  EXPECT_EQ(joined({box(0, 0, 4, 1, 300, kHole), box(3.2, 0, 2, 0.9, 90, kHole)}).size(), 1U)
      << "the ditch goes on";
  EXPECT_EQ(joined({box(0, 0, 4, 0.1, 300, kHole), box(0, 0.5, 4, 0.1, 90, kHole)}).size(), 1U)
      << "the two walls of one ditch";
}

TEST(JoinPieces, PartsOfAWallAreOne) {
  EXPECT_EQ(joined({box(3, 1, 2, 0.1, 100), box(6, 1.1, 1, 0.3, 40)}).size(), 1U);
  EXPECT_EQ(joined({box(3, 1, 2, 0.1, 100), box(6, 2, 1, 0.3, 40)}).size(), 2U)
      << "beside its line";
  EXPECT_EQ(joined({box(3, 1, 2, 0.1, 100), box(8, 1, 1, 0.3, 40)}).size(), 2U) << "3.5 m off";
  EXPECT_EQ(joined({box(3, 1, 0.8, 0.1, 100), box(5.4, 1, 0.2, 0.1, 40)}).size(), 2U)
      << "a post on the line of a board, 1.9 m off";
}

TEST(JoinPieces, LosesNothing) {
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::size_t fewer = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<Obstacle> all;
    for (int i = 0; i < 12; ++i) {
      const double length = uniform(0, 2);
      all.push_back(box(uniform(-3, 3), uniform(-3, 3), length, uniform(0, length),
                        static_cast<std::uint32_t>(uniform(1, 50)),
                        i % 2 == 0 ? ObstacleKind::positive : ObstacleKind::negative));
      all.back().yaw = uniform(-1.57, 1.57);
    }
    const auto list = joined(all);
    fewer += all.size() - list.size();
    std::uint32_t before = 0, after = 0;
    for (const Obstacle& obstacle : all) before += obstacle.points;
    for (const Obstacle& obstacle : list) {
      after += obstacle.points;
      EXPECT_GE(obstacle.extent.x(), obstacle.extent.y());
      EXPECT_LE(std::abs(obstacle.yaw), std::numbers::pi / 2 + 1e-9);
    }
    EXPECT_EQ(before, after);
    for (const Obstacle& obstacle : all) {
      for (const Eigen::Vector3d& corner : outline(obstacle)) {
        const auto holds = [&](const Obstacle& other) {
          return other.kind == obstacle.kind && distance_to_box(other, corner) < 1e-9;
        };
        EXPECT_TRUE(std::any_of(list.begin(), list.end(), holds));
      }
    }
  }
  EXPECT_GT(fewer, 200U);
  EXPECT_EQ(joined({}).size(), 0U);
}

TEST(KeepTheSurer, AHoleWithinARockIsNone) {
  constexpr auto kHole = ObstacleKind::negative;
  const Obstacle rock = box(3, 1, 1, 0.8, 50), within = box(3.4, 1.3, 2, 1, 900, kHole),
                 beside = box(3.6, 1, 0.6, 0.3, 40, kHole), inner = box(3.1, 1, 0.3, 0.2, 9);
  FixedVector<Obstacle> list(8);
  for (const Obstacle& obstacle : {within, rock, beside, inner}) list.push_back(obstacle);
  keep_the_surer(list);
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0].id, rock.id);
  EXPECT_EQ(list[1].id, beside.id) << "its middle lies on free ground";
  EXPECT_EQ(list[2].id, inner.id) << "a rock in a rock";
}

TEST(KeepTheSurer, ARockAroundASurerHoleIsItsRim) {
  Obstacle rim = box(3, 1, 1.8, 0.8, 50), far = box(8, 1, 1, 0.8, 50);
  const Obstacle hole = box(3.4, 1.3, 2, 1, 900, ObstacleKind::negative);
  rim.confidence = far.confidence = 0.8F;
  FixedVector<Obstacle> list(8);
  for (const Obstacle& obstacle : {rim, hole, far}) list.push_back(obstacle);
  keep_the_surer(list);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].id, hole.id);
  EXPECT_EQ(list[1].id, far.id);
}

}  // namespace
}  // namespace scree
