#include "scree/motion/ground_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scree/core/pose.hpp"

namespace scree {
namespace {

/// Level ground with a rock, as a lidar 0.9 m above sees it that looks 8 degrees down.
PointCloud ground_seen(double rock) {
  const Eigen::Quaterniond to_lidar = from_roll_pitch_yaw(0, radians(8), 0).conjugate();
  PointCloud points(5000);
  for (double x = -6; x <= 6; x += 0.2) {
    for (double y = -6; y <= 6; y += 0.2) {
      const double height = std::hypot(x - 3, y) < 1.2 ? rock : 0;
      const Eigen::Vector3f at = (to_lidar * Eigen::Vector3d(x, y, height - 0.9)).cast<float>();
      points.push_back(at.x(), at.y(), at.z(), 0);
    }
  }
  return points;
}

TEST(GroundPlaneTest, IsThatOfTheGroundBesideARock) {
  const auto plane = fit_ground_around(ground_seen(0.6));
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->height, 0.9, 0.02);
  const Eigen::Vector3d up = from_roll_pitch_yaw(0, radians(8), 0) * plane->normal;
  EXPECT_NEAR(degrees(std::acos(up.z())), 0, 0.5);
}

/// Blades of grass end beams at any height between the ground and theirs; most near their tops.
TEST(GroundPlaneTest, IsNoneThroughTallGrass) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> share(0, 1);
  for (const float blades : {0.05F, 0.8F}) {
    PointCloud points(5000);
    for (float x = -6; x <= 6; x += 0.2F) {
      for (float y = -6; y <= 6; y += 0.2F) {
        points.push_back(x, y, -1.1F + blades * std::sqrt(share(random)), 0);
      }
    }
    EXPECT_EQ(fit_ground_around(points).has_value(), blades < 0.1F);
  }
}

TEST(GroundPlaneTest, IsNoneWhereNothingLiesBelow) {
  PointCloud points(100);
  for (int i = 0; i < 100; ++i) points.push_back(static_cast<float>(i), 0, 1, 0);
  EXPECT_FALSE(fit_ground_around(points));
}

TEST(GroundPlaneTest, KnowsTheHeightOfAPlaceAboveIt) {
  const GroundPlane plane = fit_ground_below(ground_seen(0), {0, 0, 0});
  EXPECT_NEAR(plane.height, 0.9, 0.01);
}

}  // namespace
}  // namespace scree
