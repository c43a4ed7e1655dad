#include "scree/detect/gradient_raster.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "detect/clouds.hpp"
#include "detect/slope_by_formula.hpp"

namespace scree {
namespace {

using Role = GradientRaster::Role;

std::vector<Role> all_ask(const PointCloud& cloud) {
  return std::vector<Role>(cloud.size(), Role::asks);
}

class GradientRasterOf : public testing::TestWithParam<double> {};  // bandwidth in radii

TEST_P(GradientRasterOf, IsTheFormulaOfThePaperAtItsPlaces) {
  const PointCloud cloud = test::bump_and_bowl(4000);
  const double d = 0.2, r = 0.23, bandwidth = GetParam() * r;
  const int least = 2;
  GradientRaster raster(10'000);
  raster.build(cloud, all_ask(cloud), {float(d), float(r), float(bandwidth), least});
  std::size_t known = 0, on_the_rim = 0;
  for (std::size_t i = 0; i < cloud.size(); i += 7) {
    // Places are whole multiples of d.
    const auto expected =
        test::slope_by_formula(cloud, d * std::round(cloud.x[i] / d),
                               d * std::round(cloud.y[i] / d), {d, r, bandwidth, least});
    const Slope slope = raster.at(cloud.x[i], cloud.y[i]);
    if (std::isnan(slope.x) == expected.has_value()) {
      ++on_the_rim;
      continue;
    }
    if (!expected) continue;
    ++known;
    // A neighbour on the rim of a disc may fall on either side in float.
    if (!test::is_slope(slope.x, slope.y, *expected)) ++on_the_rim;
  }
  EXPECT_GT(known, 300U);
  EXPECT_LE(on_the_rim, known / 100);
}

INSTANTIATE_TEST_SUITE_P(Bandwidths, GradientRasterOf, testing::Values(2.0, 1.0, 0.3, 0.1));

TEST(GradientRaster, DoesNotCountWhatIsLeftOut) {
  PointCloud cloud = test::scattered(20'000, 2, 0);
  std::vector<Role> roles = all_ask(cloud);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (i % 2 == 0) roles[i] = Role::left_out;
    cloud.z[i] = roles[i] == Role::left_out ? cloud.x[i] * 5 : cloud.x[i] * 0.3F;
  }
  GradientRaster raster(10'000);
  raster.build(cloud, roles, {0.1F, 0.11F, 0.22F, 1});
  const Slope slope = raster.at(0, 0);
  EXPECT_NEAR(slope.x, 0.3, 0.03);
  EXPECT_NEAR(slope.y, 0, 0.03);
}

TEST(GradientRaster, IsTheSameWhereFewAskAsWhereAllDo) {
  const PointCloud cloud = test::bump_and_bowl(4000);
  const ElevationGradient gradient{0.1F, 0.13F, 0.2F, 1};
  GradientRaster all(10'000), few(10'000);
  std::vector<Role> roles(cloud.size(), Role::counts);
  for (std::size_t i = 0; i < cloud.size(); i += 37) roles[i] = Role::asks;
  all.build(cloud, all_ask(cloud), gradient);
  few.build(cloud, roles, gradient);
  std::size_t known = 0;
  for (std::size_t i = 0; i < cloud.size(); i += 37) {
    const Slope expected = all.at(cloud.x[i], cloud.y[i]), slope = few.at(cloud.x[i], cloud.y[i]);
    EXPECT_EQ(std::isnan(slope.x), std::isnan(expected.x));
    if (std::isnan(expected.x)) continue;
    ++known;
    EXPECT_EQ(slope.x, expected.x);
    EXPECT_EQ(slope.y, expected.y);
  }
  EXPECT_GT(known, 30U);
}

TEST(GradientRaster, IsNotKnownWherePointsLack) {
  PointCloud cloud(3);
  for (const float x : {0.0F, 0.1F, 5.0F}) cloud.push_back(x, 0, 0, 0);
  GradientRaster raster(10'000);
  raster.build(cloud, all_ask(cloud), {0.1F, 0.11F, 0.22F, 1});
  for (const float x : cloud.x) EXPECT_TRUE(std::isnan(raster.at(x, 0).x));
  raster.build(PointCloud(), {}, {0.1F, 0.11F, 0.22F, 1});
}

TEST(GradientRaster, GrowsCoarserWhereACloudIsTooWideForIt) {
  PointCloud cloud = test::scattered(20'000, 5, 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.z[i] = 0.4F * cloud.x[i] - 0.2F * cloud.y[i];
  GradientRaster raster(1000);  // 10 m in steps of 0.1 m would be ten times as many
  raster.build(cloud, all_ask(cloud), {0.1F, 0.11F, 0.22F, 1});
  EXPECT_NEAR(raster.at(1, -1).x, 0.4, 0.03);
  EXPECT_NEAR(raster.at(1, -1).y, -0.2, 0.03);
}

}  // namespace
}  // namespace scree
