#include "scree/terrain/moving_points.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

/// A lidar 1 m above `base`, before a wall 10 m ahead, in a room that is known to be free.
class MovingPointsTest : public testing::Test {
protected:
  MovingPointsTest() {
    for (std::uint32_t sweep = 1; sweep < 20; ++sweep) {
      for (float x = 1.1F; x < 9; x += 0.25F) {
        for (float y = -3.9F; y < 4; y += 0.25F) {
          for (float z = 0.3F; z < 2; z += 0.25F) free_.add_misses({x, y, z}, sweep, 4);
        }
      }
    }
  }

  void see(float x, float y, float z, bool is_isolated = false) {
    sweep_.points.push_back(x, y, z, 20);
    sweep_.origins.push_back(Eigen::Vector3f(0, 0, 1));
    sweep_.is_isolated.push_back(is_isolated ? 1 : 0);
  }
  /// The front of something 0.4 m wide from the ground to `top`, every other beam through it.
  void see_front(float x, float y, float top, bool lets_half_through = false) {
    int beam = 0;
    for (float z = 0.05F; z < top; z += 0.15F) {
      for (float side = -0.2F; side <= 0.2F; side += 0.04F) {
        const float share = lets_half_through && beam++ % 3 != 0 ? 9.9F / x : 1;
        see(share * x, share * (y + side), 1 + share * (z - 1));
      }
    }
  }
  std::size_t find(float reach = 12) {
    points_.find(sweep_, Pose(), free_, reach);
    EXPECT_EQ(sweep_.is_moving.size(), sweep_.points.size());
    return points_.size();
  }
  std::size_t marked() const {
    return static_cast<std::size_t>(
        std::count(sweep_.is_moving.begin(), sweep_.is_moving.end(), 1));
  }

  FreeSpace free_;
  DeskewedSweep sweep_{1 << 14};
  MovingPoints points_{1 << 14};
};

TEST_F(MovingPointsTest, SomeoneWhereNobodyWasIsMovingFromHeadToFoot) {
  see_front(5, 1, 1.7F);
  const std::size_t person = sweep_.points.size();
  see(5, -2, 0.02F);
  ASSERT_EQ(find(), 1U);
  EXPECT_EQ(marked(), person) << "the feet too, though the ground's cells are not clear";
  for (const std::uint32_t i : points_.members(0)) EXPECT_GT(sweep_.points.z[i], 0.25F);
  EXPECT_EQ(sweep_.is_moving[person], 0);
}

TEST_F(MovingPointsTest, TwoAreTwo) {
  see_front(5, 1, 1.7F);
  see_front(6, -1, 1.2F);
  EXPECT_EQ(find(), 2U);
}

TEST_F(MovingPointsTest, WhatStandsInUnknownPlacesIsNotMoving) {
  see_front(5, 8, 1.7F);
  EXPECT_EQ(find(), 0U);
  EXPECT_EQ(marked(), 0U);
}

TEST_F(MovingPointsTest, ARingOnGroundThatComesIntoViewIsNotMoving) {
  for (float y = -2; y < 2; y += 0.02F) see(5, y, 0.3F);
  EXPECT_EQ(find(), 0U);
}

TEST_F(MovingPointsTest, WhatLetsMostBeamsThroughIsNotMoving) {
  see_front(5, 1, 1.7F, true);
  EXPECT_EQ(find(), 0U);
}

TEST_F(MovingPointsTest, GrainsAndFewPointsAreNotMoving) {
  for (int i = 0; i < 5; ++i) see(5, 1, 0.5F + 0.2F * static_cast<float>(i));
  for (int i = 0; i < 50; ++i) see(4, -1, 0.5F + 0.02F * static_cast<float>(i), true);
  EXPECT_EQ(find(), 0U);
}

TEST_F(MovingPointsTest, BeyondTheReachNothingIsLookedAt) {
  see_front(5, 1, 1.7F);
  EXPECT_EQ(find(4), 0U);
  see(500, -3, 2);
  see(-500, 20000, 2);
  EXPECT_EQ(find(1e6F), 1U);
}

TEST_F(MovingPointsTest, AnEmptySweepHasNone) {
  EXPECT_EQ(find(), 0U);
}

}  // namespace
}  // namespace scree
