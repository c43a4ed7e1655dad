#include "scree/detect/grid_maker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "allocation_counter.hpp"
#include "detect/clouds.hpp"

namespace scree {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
constexpr GridSettings kSettings{.cell_size = 0.2, .reach = 6, .body_height = 0.06F};

/// Seen every 4 cm within 4 m of the middle; nothing where the height is kNothing.
PointCloud seen_ground(const std::function<float(float, float)>& height, float spacing = 0.04F) {
  PointCloud cloud(60'000);
  const int half = static_cast<int>(4 / spacing);
  for (int i = -half; i < half; ++i) {
    for (int j = -half; j < half; ++j) {
      const float x = (static_cast<float>(i) + 0.5F) * spacing;
      const float y = (static_cast<float>(j) + 0.5F) * spacing;
      const float z = height(x, y);
      if (!std::isnan(z)) cloud.push_back(x, y, z, 0);
    }
  }
  return cloud;
}

float level_ground(float, float) {
  return 0;
}

Obstacle box_at(ObstacleKind kind, double x, double y, double edge) {
  Obstacle obstacle;
  obstacle.kind = kind;
  obstacle.center = {x, y, 0};
  obstacle.extent = {edge, edge, 0.3};
  return obstacle;
}

class GridMakerTest : public testing::Test {
protected:
  const ObstacleGrid& look(const PointCloud& cloud, const GridSettings& settings = kSettings) {
    surface_.build(cloud);
    maker_ = GridMaker(settings);
    return make();
  }
  const ObstacleGrid& make() {
    return grid_ = &maker_.make(surface_, surface_in_odom_, list_), *grid_;
  }
  std::size_t cell_at(double x, double y) const {
    const Eigen::Array2d place = (Eigen::Vector2d(x, y) - grid_->origin) / grid_->cell_size;
    return static_cast<std::size_t>(place.y()) * grid_->columns +
           static_cast<std::size_t>(place.x());
  }
  /// Of the cell in which a place of `odom` lies.
  CellState state(double x, double y) const { return grid_->state[cell_at(x, y)]; }
  double ground(double x, double y) const { return 0.01 * grid_->ground[cell_at(x, y)]; }

  GroundSurface surface_{test::kGroundSettings, 60'000, 1 << 15};
  Pose surface_in_odom_;
  ObstacleList list_{4};
  GridMaker maker_{kSettings};
  const ObstacleGrid* grid_ = nullptr;
};

TEST_F(GridMakerTest, GroundThatWasSeenIsFreeAndNoneBeyondIt) {
  look(seen_ground(level_ground));
  for (const double x : {-3.9, -0.1, 0.1, 2.5, 3.7}) EXPECT_EQ(state(x, 1), CellState::free) << x;
  for (const double x : {-5.0, 4.3, 5.9}) {
    EXPECT_EQ(state(x, 1), CellState::unknown) << x;
    EXPECT_EQ(grid_->ground[cell_at(x, 1)], ObstacleGrid::kNoGround) << x;
  }
}

TEST_F(GridMakerTest, GroundThatIsSpannedIsUnknown) {
  // Behind a wall nothing was seen, and farther on ground again.
  look(seen_ground([](float x, float y) {
    if (std::abs(y) > 1 || x < 1) return 0.0F;
    return x < 1.2F ? 1.0F : x < 2.4F ? kNothing : 0.0F;
  }));
  EXPECT_TRUE(std::abs(surface_.height(1.9F, 0)) < 0.05F) << "it is spanned";
  for (const double x : {1.3, 1.5, 1.9, 2.3}) EXPECT_EQ(state(x, 0), CellState::unknown) << x;
  EXPECT_EQ(state(0.7, 0), CellState::free);
  EXPECT_EQ(state(2.7, 0), CellState::free);
}

TEST_F(GridMakerTest, WhatStandsOrLiesOffTheGroundUnpublishedIsUnknown) {
  for (const float height : {0.3F, -0.3F}) {
    look(
        seen_ground([&](float x, float y) { return test::in_square(x, y, 0.3F) ? height : 0.0F; }));
    EXPECT_EQ(state(0.1, 0.1), CellState::unknown) << height;
    EXPECT_EQ(state(0.9, 0.1), CellState::free) << height;
  }
}

TEST_F(GridMakerTest, AThinStickMakesItsCellUnknown) {
  PointCloud cloud = seen_ground(level_ground);
  cloud.push_back(1.1F, 1.1F, 0.4F, 0);
  look(cloud);
  EXPECT_EQ(state(1.1, 1.1), CellState::unknown);
  EXPECT_EQ(state(1.5, 1.1), CellState::free);
}

TEST_F(GridMakerTest, CellsOfAPublishedObstacleSayItsKindAndTheGroundAroundIt) {
  list_.pose.translation = {0, 0, -0.5};
  list_.obstacles.push_back(box_at(ObstacleKind::positive, 1, 1, 0.5));
  list_.obstacles.push_back(box_at(ObstacleKind::negative, -1, 1, 0.5));
  look(seen_ground([](float x, float y) {
    if (test::in_square(x - 1, y - 1, 0.25F)) return 0.4F;
    return test::in_square(x + 1, y - 1, 0.25F) ? -0.4F : 0.0F;
  }));
  EXPECT_EQ(state(1, 1), CellState::occupied);
  EXPECT_EQ(state(-1, 1), CellState::drop);
  EXPECT_EQ(state(0, 1), CellState::free);
  for (const double x : {1, -1, 0}) EXPECT_NEAR(ground(x, 1), 0.5, 0.02) << x;
}

TEST_F(GridMakerTest, APublishedObstacleCoversAlsoWhereNothingWasSeen) {
  list_.obstacles.push_back(box_at(ObstacleKind::negative, 5, 0, 1));
  look(seen_ground(level_ground));
  EXPECT_EQ(state(4.9, 0.1), CellState::drop);
  EXPECT_NEAR(ground(4.9, 0.1), 0, 0.02);
}

TEST_F(GridMakerTest, AFootprintSmallerThanACellCoversIt) {
  list_.obstacles.push_back(box_at(ObstacleKind::positive, 1.05, 1.05, 0.02));
  look(seen_ground(level_ground));
  EXPECT_EQ(state(1.05, 1.05), CellState::occupied);
  EXPECT_EQ(std::ranges::count(grid_->state, CellState::occupied), 1);
}

TEST_F(GridMakerTest, ATurnedFootprintCoversWhatItTouchesAndNoMore) {
  Obstacle diamond = box_at(ObstacleKind::positive, 0, 0, 1);
  diamond.yaw = radians(45);
  list_.obstacles.push_back(diamond);
  look(seen_ground(level_ground));
  EXPECT_EQ(state(0.5, 0.1), CellState::occupied);
  EXPECT_EQ(state(-0.1, -0.5), CellState::occupied);
  EXPECT_EQ(state(0.5, 0.5), CellState::free) << "in its box, not in it";
}

TEST_F(GridMakerTest, WhatIsNotAPlaceAtAllOrFarAwayCoversNothing) {
  list_.obstacles.push_back(box_at(ObstacleKind::positive, std::nan(""), 0, 1));
  list_.obstacles.push_back(box_at(ObstacleKind::negative, 1e12, -1e12, 1));
  look(seen_ground(level_ground));
  EXPECT_EQ(std::ranges::count(grid_->state, CellState::occupied), 0);
  EXPECT_EQ(std::ranges::count(grid_->state, CellState::drop), 0);
}

TEST_F(GridMakerTest, ScrollsByWholeCells) {
  const PointCloud cloud = seen_ground([](float x, float) { return x < 0 ? 0 : kNothing; });
  for (const double x : {0.0, 0.03, 0.17, 0.4, -0.77, 1.1}) {
    list_.pose.translation.x() = x;
    look(cloud);
    const double cells = grid_->origin.x() / 0.2;
    EXPECT_NEAR(cells, std::round(cells), 1e-9) << x;
    EXPECT_NEAR(grid_->origin.x() + 0.1 * static_cast<double>(grid_->columns), x, 0.1001) << x;
    EXPECT_EQ(grid_->columns, 60U);
    EXPECT_EQ(state(-0.1, 0.5), CellState::free) << x;
    EXPECT_EQ(state(0.3, 0.5), CellState::unknown) << x;
  }
}

TEST_F(GridMakerTest, LiesInOdomWhereverTheSurfaceIs) {
  surface_in_odom_.translation = {100, -50, 7};
  surface_in_odom_.rotation = from_roll_pitch_yaw(0, 0.02, 0);
  list_.pose.translation = {101, -50, 6.5};
  look(
      seen_ground([](float x, float y) { return test::in_square(x - 1, y, 0.4F) ? kNothing : 0; }));
  EXPECT_EQ(state(101.1, -49.9), CellState::unknown);
  EXPECT_EQ(state(99, -50.5), CellState::free);
  EXPECT_NEAR(ground(99, -50.5), 0.5 + 0.02, 0.011);
  EXPECT_NEAR(ground(103, -50.5), 0.5 - 0.06, 0.011);
}

TEST_F(GridMakerTest, CellsOfTheSurfaceWiderThanItsOwnTellNothing) {
  look(seen_ground(level_ground, 0.25F));
  ASSERT_GT(surface_.cell_size(), 0.2F);
  EXPECT_EQ(std::ranges::count(grid_->state, CellState::free), 0);
  list_.obstacles.push_back(box_at(ObstacleKind::positive, 1, 1, 0.5));
  make();
  EXPECT_EQ(state(1, 1), CellState::occupied);
  GridSettings wide = kSettings;
  wide.cell_size = 0.5;
  look(seen_ground(level_ground, 0.25F), wide);
  EXPECT_EQ(state(-1.2, 1.2), CellState::free);
}

TEST_F(GridMakerTest, NeverHasMoreCellsThanItHasRoomFor) {
  GridSettings settings = kSettings;
  settings.cell_size = 0.1;
  settings.reach = 15;
  look(seen_ground(level_ground), settings);
  EXPECT_EQ(grid_->columns, ObstacleGrid::kMostCells);
  EXPECT_EQ(grid_->state.size(), grid_->cells());
  EXPECT_EQ(grid_->ground.size(), grid_->cells());
  EXPECT_EQ(state(1, 1), CellState::free);
}

TEST_F(GridMakerTest, NothingSeenIsAllUnknown) {
  look(PointCloud(10));
  EXPECT_EQ(std::ranges::count(grid_->state, CellState::unknown), 60 * 60);
}

TEST_F(GridMakerTest, AllocatesNothing) {
  list_.obstacles.push_back(box_at(ObstacleKind::positive, 1, 1, 0.5));
  look(seen_ground(level_ground));
  ObstacleGrid copy;
  const std::size_t before = test::allocations();
  make();
  list_.pose.translation.x() += 3;
  copy.copy_from(make());
  EXPECT_EQ(test::allocations(), before);
  EXPECT_EQ(copy.origin, grid_->origin);
  EXPECT_TRUE(std::ranges::equal(copy.state, grid_->state));
  EXPECT_TRUE(std::ranges::equal(copy.ground, grid_->ground));
}

}  // namespace
}  // namespace scree
