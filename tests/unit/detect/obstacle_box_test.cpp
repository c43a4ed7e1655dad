#include "scree/detect/obstacle_box.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "detect/boxes.hpp"

namespace scree {
namespace {

TEST(DistanceToBox, IsMeasuredFromItsEdgesInThePlane) {
  Obstacle rock = box(1, 2, 2, 1, 100);
  rock.yaw = std::numbers::pi / 2;
  EXPECT_EQ(distance_to_box(rock, {1, 2, 9}), 0);
  EXPECT_EQ(distance_to_box(rock, {1.4, 2.9, 0}), 0);
  EXPECT_NEAR(distance_to_box(rock, {2.5, 2, 0}), 1, 1e-12);
  EXPECT_NEAR(distance_to_box(rock, {1, 3.5, 0}), 0.5, 1e-12);
  EXPECT_NEAR(distance_to_box(rock, {1.8, 3.4, 0}), 0.5, 1e-12) << "from a corner";
}

}  // namespace
}  // namespace scree
