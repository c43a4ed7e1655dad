#include "draw/height_raster.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree::cli {
namespace {

PointCloud cloud_of(const std::vector<Eigen::Vector3f>& points) {
  PointCloud cloud(points.size());
  for (const auto& point : points) cloud.push_back(point.x(), point.y(), point.z(), 0);
  return cloud;
}

/// Level ground of 6 m, a metre deep within the square of half a metre to each side of the origin.
HeightGrid pit() {
  HeightGrid grid{-3, -3, 0.1, 60, 60, std::vector<float>(3600, 0.0F)};
  for (std::size_t row = 25; row < 35; ++row) {
    for (std::size_t column = 25; column < 35; ++column) grid.at(column, row) = -1;
  }
  return grid;
}

TEST(HeightRaster, ACellHasTheMeanOfItsPointsInTheFrameOfTheRaster) {
  HeightRaster raster(0.5);
  const Pose frame{{10, 0, 1}, from_roll_pitch_yaw(0, 0, radians(90))};
  raster.add(cloud_of({{0.1F, -0.1F, 0.0F}, {0.2F, -0.2F, 0.2F}, {0.6F, -0.1F, 5.0F}}), frame);
  const HeightGrid grid = raster.grid(100);
  ASSERT_EQ(grid.columns, 1U);
  ASSERT_EQ(grid.rows, 2U);
  EXPECT_DOUBLE_EQ(grid.x, 10);
  EXPECT_DOUBLE_EQ(grid.y, 0);
  EXPECT_NEAR(grid.at(0, 0), 1.1, 1e-6);
  EXPECT_NEAR(grid.at(0, 1), 6, 1e-6);
}

TEST(HeightRaster, WhatHangsOverTheGroundIsLeftOut) {
  HeightRaster raster(1);
  raster.add(cloud_of({{0.5F, 0.5F, 3.5F}, {0.5F, 0.5F, 0.0F}, {0.5F, 0.5F, 0.4F}}), Pose());
  EXPECT_NEAR(raster.grid(10).at(0, 0), 0.2, 1e-6);
}

TEST(HeightRaster, WhatIsSeenAgainTakesThePlaceAndNoNumbersAreNotTaken) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  HeightRaster raster(1);
  raster.add(cloud_of({{-0.5F, 0.5F, 1}, {0.5F, 0.5F, 1}}), Pose());
  raster.add(cloud_of({{0.5F, 0.5F, 3}, {kNan, 0, 0}, {0, 1e30F, 0}}), Pose());
  const HeightGrid grid = raster.grid(100);
  ASSERT_EQ(grid.columns * grid.rows, 2U);
  EXPECT_DOUBLE_EQ(grid.x, -1);
  EXPECT_FLOAT_EQ(grid.at(0, 0), 1);
  EXPECT_FLOAT_EQ(grid.at(1, 0), 3);
}

TEST(HeightRaster, LargerCellsStandForManyWhereThereWouldBeTooMany) {
  HeightRaster raster(0.1);
  std::vector<Eigen::Vector3f> points;
  for (int i = -100; i < 100; ++i)
    points.emplace_back(0.1F * static_cast<float>(i) + 0.05F, 0.05F, 2);
  raster.add(cloud_of(points), Pose());
  EXPECT_EQ(raster.grid(200).columns, 200U);
  const HeightGrid grid = raster.grid(60);
  EXPECT_EQ(grid.columns, 50U);
  EXPECT_DOUBLE_EQ(grid.cell, 0.4);
  EXPECT_NEAR(grid.x, -10, 1e-9);
  EXPECT_TRUE(std::ranges::all_of(grid.heights, [](float height) { return height == 2; }));
  EXPECT_EQ(HeightRaster(1).grid(10).columns, 0U);
}

TEST(HeightRaster, TheGroundOfAGridIsTaken) {
  ObstacleGrid grid;
  grid.pose.translation.z() = 1;
  grid.origin = {-0.4, 0.2};
  grid.cell_size = 0.2;
  grid.columns = 2;
  grid.rows = 1;
  for (const auto state : {CellState::free, CellState::unknown}) grid.state.push_back(state);
  for (const std::int16_t ground : {std::int16_t{-50}, ObstacleGrid::kNoGround})
    grid.ground.push_back(ground);
  HeightRaster raster(0.1);
  raster.add(grid);
  const HeightGrid taken = raster.grid(10);
  ASSERT_EQ(taken.heights.size(), 1U);
  EXPECT_DOUBLE_EQ(taken.cell, 0.2);
  EXPECT_NEAR(taken.x, -0.4, 1e-9);
  EXPECT_FLOAT_EQ(taken.at(0, 0), 0.5F);
}

TEST(Hillshade, APitIsDarkAndTheGroundAroundItEvenlyBright) {
  const HeightGrid grid = pit();
  const std::vector<float> bright = hillshade(grid);
  const float flat = bright[5 * 60 + 5], bottom = bright[30 * 60 + 30];
  EXPECT_NEAR(flat, 0.8, 0.01);
  EXPECT_LT(bottom, flat - 0.15F);
  // Lit from the upper left, where x and y are large: the wall that looks there is the bright one.
  const float looks_to_light = bright[25 * 60 + 30], looks_away = bright[34 * 60 + 30];
  EXPECT_GT(looks_to_light, looks_away);
}

TEST(Hillshade, UnknownStaysUnknownAndGapsAreFilledFromTheirNeighbours) {
  HeightGrid grid = pit();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t column = 0; column < 10; ++column) grid.at(column, 3) = kNan;
  for (std::size_t row = 50; row < 60; ++row) {
    for (std::size_t column = 50; column < 60; ++column) grid.at(column, row) = kNan;
  }
  EXPECT_TRUE(std::isnan(hillshade(grid)[3 * 60 + 5]));
  fill_gaps(grid, 2);
  EXPECT_FLOAT_EQ(grid.at(5, 3), 0);
  EXPECT_TRUE(std::isnan(grid.at(57, 57)));
  EXPECT_FALSE(std::isnan(grid.at(51, 51)));
}

}  // namespace
}  // namespace scree::cli
