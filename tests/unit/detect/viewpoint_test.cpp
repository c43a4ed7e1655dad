#include "scree/detect/viewpoint.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

/// Ground around the origin, and a wall of 2 m at x = 5.
PointCloud wall_and_ground(bool ground_behind) {
  PointCloud cloud(40'000);
  for (float x = -8; x < (ground_behind ? 12 : 5); x += 0.1F) {
    for (float y = -8; y < 8; y += 0.1F) cloud.push_back(x, y, 0, 0);
  }
  for (float y = -8; y < 8; y += 0.1F) {
    for (float z = 0; z < 2; z += 0.1F) cloud.push_back(5, y, z, 0);
  }
  return cloud;
}

TEST(Viewpoint, ACloudWithoutAnythingHiddenCanBeSeenFromAboveItsGround) {
  EXPECT_TRUE(could_be_seen_from({0, 0, 1}, wall_and_ground(false)));
}

TEST(Viewpoint, NothingIsSeenFromTheGroundItself) {
  EXPECT_FALSE(could_be_seen_from({0, 0, 0}, wall_and_ground(false)));
}

TEST(Viewpoint, WhatLiesBehindAWallWasSeenFromElsewhere) {
  EXPECT_FALSE(could_be_seen_from({0, 0, 1}, wall_and_ground(true)));
}

TEST(Viewpoint, OfNoPointsIsNone) {
  EXPECT_FALSE(could_be_seen_from({0, 0, 1}, PointCloud(1)));
  PointCloud nan(1);
  nan.push_back(std::nanf(""), 0, 0, 0);
  EXPECT_FALSE(could_be_seen_from({0, 0, 1}, nan));
}

}  // namespace
}  // namespace scree
