#include "scree/detect/overhangs.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace scree {
namespace {

/// Ground on a slope of 20 %, ten points a metre, from -5 to 5 m.
PointCloud sloping_ground() {
  PointCloud cloud(20'000);
  for (int u = -50; u < 50; ++u) {
    for (int v = -50; v < 50; ++v) {
      const float x = 0.1F * static_cast<float>(u), y = 0.1F * static_cast<float>(v);
      cloud.push_back(x, y, 0.2F * x, 10);
    }
  }
  return cloud;
}

TEST(Overhangs, AreWhatHangsHigherThanTheClearance) {
  PointCloud cloud = sloping_ground();
  const std::size_t ground = cloud.size();
  for (int i = 0; i < 50; ++i) {
    const float x = -2.5F + 0.1F * static_cast<float>(i);
    cloud.push_back(x, 0.5F, 0.2F * x + 2.5F, 200);  // a bough
    cloud.push_back(x, 1.5F, 0.2F * x + 1.5F, 100);  // in the way
  }
  Overhangs overhangs(1000);
  overhangs.remove(cloud, 2);
  EXPECT_EQ(cloud.size(), ground + 50);
  EXPECT_EQ(std::ranges::count(cloud.reflectivity, 200), 0);
  EXPECT_EQ(std::ranges::count(cloud.reflectivity, 100), 50);
}

TEST(Overhangs, TwoStrayPointsBelowTheGroundDoNoHarm) {
  PointCloud cloud = sloping_ground();
  cloud.push_back(0.5F, 0.5F, -8, 0);
  cloud.push_back(0.6F, 0.6F, -9, 0);
  const std::size_t all = cloud.size();
  Overhangs overhangs(1000);
  overhangs.remove(cloud, 2);
  EXPECT_EQ(cloud.size(), all);
}

TEST(Overhangs, HaveWiderColumnsWhereACloudIsWide) {
  PointCloud cloud = sloping_ground();
  cloud.push_back(0.5F, 0.5F, 5, 200);
  const std::size_t all = cloud.size();
  Overhangs overhangs(9);  // of 4 m for these 10 m
  overhangs.remove(cloud, 2);
  EXPECT_EQ(cloud.size(), all - 1);
}

TEST(Overhangs, OfNothingAreNothing) {
  PointCloud cloud;
  Overhangs overhangs(4);
  overhangs.remove(cloud, 2);
  EXPECT_TRUE(cloud.empty());
}

}  // namespace
}  // namespace scree
