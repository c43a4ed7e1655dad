#include "scree/detect/fragment_merger.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "detect/boxes.hpp"
#include "scree/detect/enclosing_polygon.hpp"
#include "scree/detect/obstacle_box.hpp"

namespace scree {
namespace {

FixedVector<Obstacle> merged(const std::vector<Obstacle>& obstacles) {
  FixedVector<Obstacle> list(64);
  for (const Obstacle& obstacle : obstacles) list.push_back(obstacle);
  FragmentMerger(64).merge(list);
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

TEST(FragmentMerger, WhatIsMostlyOneThingStaysOne) {
  const Obstacle rock = box(5, 0, 1, 1, 100);
  Obstacle sliver = box(5.75, 0, 0.1, 0.1, 10);
  const Obstacle away = [&] {
    Obstacle moved = sliver;
    moved.center.x() = 6.5;
    return moved;
  }();
  FragmentMerger merger(64);
  const auto count = [&](const Obstacle& second) {
    FixedVector<Obstacle> list(64);
    list.push_back(rock);
    list.push_back(second);
    merger.merge(list);
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

TEST(FragmentMerger, ASliverBesideARockBelongsToIt) {
  const Obstacle sliver = box(3.9, 1, 0.6, 0.1, 12);
  const Obstacle rock = box(3, 1, 1, 0.8, 200);
  const auto list = merged({sliver, rock});
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].id, std::min(sliver.id, rock.id)) << "the id that it had first";
  EXPECT_EQ(list[0].points, 212U);
  EXPECT_NEAR(list[0].extent.x(), 1.7, 1e-9) << "from 2.5 to 4.2";
  EXPECT_NEAR(list[0].center.x(), 3.35, 1e-9);
  EXPECT_NEAR(list[0].extent.y(), 0.8, 1e-9);
  EXPECT_NEAR(list[0].extent.z(), 0.4, 1e-9);
}

ConvexPolygon footprint_of(const Obstacle& obstacle) {
  std::vector<Eigen::Vector2d> corners;
  for (const Eigen::Vector3d& corner : outline(obstacle)) corners.push_back(corner.head<2>());
  return enclosing_polygon(corners);
}

TEST(FragmentMerger, TheFootprintHoldsThoseOfAllFragments) {
  Obstacle rock = box(5, 0, 1, 1, 100), sliver = box(5.75, 0, 0.1, 0.1, 10);
  rock.footprint = footprint_of(rock);
  sliver.footprint = footprint_of(sliver);
  const FixedVector<Obstacle> list = merged({rock, sliver});
  ASSERT_EQ(list.size(), 1U);
  EXPECT_TRUE(list[0].footprint.contains({4.51, 0.49}));
  EXPECT_TRUE(list[0].footprint.contains({5.79, 0.01}));
  EXPECT_FALSE(list[0].footprint.contains({5.79, 0.3}));
}

TEST(FragmentMerger, RocksBesideOneAnotherStayTwo) {
  EXPECT_EQ(merged({box(3, 1, 0.6, 0.5, 100), box(4, 1, 0.6, 0.5, 90)}).size(), 2U);
  EXPECT_EQ(merged({box(3, 1, 1, 0.8, 200), box(4.5, 1, 0.6, 0.1, 12)}).size(), 2U)
      << "a sliver 0.7 m off";
  EXPECT_EQ(merged({box(3, 1, 2, 1.5, 2000), box(4.25, 1, 0.45, 0.3, 35)}).size(), 2U)
      << "a small one at the foot of a large one";
  EXPECT_EQ(merged({box(3, 1, 2, 1.5, 2000), box(3.9, 1, 0.45, 0.3, 35)}).size(), 1U)
      << "a part of it";
}

TEST(FragmentMerger, HolesBesideOneAnotherAreOne) {
  constexpr auto kHole = ObstacleKind::negative;
  EXPECT_EQ(merged({box(3, 1, 1, 0.5, 100, kHole), box(4.2, 1, 0.6, 0.5, 90, kHole)}).size(), 1U);
  EXPECT_EQ(merged({box(3, 1, 1, 0.5, 100, kHole), box(4.5, 1, 0.6, 0.5, 90, kHole)}).size(), 2U);
  EXPECT_EQ(merged({box(3, 1, 1, 0.5, 100), box(3.6, 1, 0.6, 0.1, 9, kHole)}).size(), 2U)
      << "a hole at a rock's foot";
}

TEST(FragmentMerger, ADitchAndAPitBesideItsEndStayTwo) {
  constexpr auto kHole = ObstacleKind::negative;
  EXPECT_EQ(merged({box(0, 0, 4, 1, 300, kHole), box(1.5, 1.6, 1.5, 1.5, 90, kHole)}).size(), 2U)
      << "one box of both would hold 3 square metres of ground";
  EXPECT_EQ(merged({box(0, 0, 4, 1, 300, kHole), box(3.2, 0, 2, 0.9, 90, kHole)}).size(), 1U)
      << "the ditch goes on";
  EXPECT_EQ(merged({box(0, 0, 4, 0.1, 300, kHole), box(0, 0.5, 4, 0.1, 90, kHole)}).size(), 1U)
      << "the two walls of one ditch";
}

TEST(FragmentMerger, PartsOfAWallAreOne) {
  EXPECT_EQ(merged({box(3, 1, 2, 0.1, 100), box(6, 1.1, 1, 0.3, 40)}).size(), 1U);
  EXPECT_EQ(merged({box(3, 1, 2, 0.1, 100), box(6, 2, 1, 0.3, 40)}).size(), 2U)
      << "beside its line";
  EXPECT_EQ(merged({box(3, 1, 2, 0.1, 100), box(8, 1, 1, 0.3, 40)}).size(), 2U) << "3.5 m off";
  EXPECT_EQ(merged({box(3, 1, 0.8, 0.1, 100), box(5.4, 1, 0.2, 0.1, 40)}).size(), 2U)
      << "a post on the line of a board, 1.9 m off";
}

TEST(FragmentMerger, PartsOfAFacadeOrABankThatTouchAreOne) {
  const auto side = [](double x, double y, double yaw) {
    Obstacle part = box(x, y, 4, 0.4, 90);
    part.yaw = yaw;
    return part;
  };
  const Obstacle front = box(0, 1, 10, 0.4, 300);
  EXPECT_EQ(merged({front, side(7.2, 1.1, 0.07)}).size(), 1U);
  EXPECT_EQ(merged({front, side(5.2, 3.2, std::numbers::pi / 2)}).size(), 2U) << "a corner";
  EXPECT_EQ(merged({front, side(8, 1, 0)}).size(), 2U) << "a gate of 1 m between them";
}

TEST(FragmentMerger, LosesNothing) {
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
    const auto list = merged(all);
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
  EXPECT_EQ(merged({}).size(), 0U);
}

}  // namespace
}  // namespace scree
