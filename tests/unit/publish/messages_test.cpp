#include "scree/publish/messages.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace scree {
namespace {

grid_t two_cell_grid() {
  ObstacleGrid grid;
  grid.stamp_ns = 12;
  grid.pose.translation = {1, 2, 3};
  grid.origin = {-0.4, 0.2};
  grid.cell_size = 0.2;
  grid.columns = 2;
  grid.rows = 1;
  grid.state.push_back(CellState::drop);
  grid.state.push_back(CellState::unknown);
  grid.ground.push_back(-40);
  grid.ground.push_back(ObstacleGrid::kNoGround);
  grid_t message;
  to_message(grid, message);
  return message;
}

TEST(GridMessage, ComesBackAsItWas) {
  ObstacleGrid grid;
  ASSERT_TRUE(from_message(two_cell_grid(), grid));
  EXPECT_EQ(grid.stamp_ns, 12);
  EXPECT_EQ(grid.pose.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(grid.origin, Eigen::Vector2d(-0.4, 0.2));
  EXPECT_EQ(grid.cells(), 2U);
  EXPECT_EQ(grid.state[0], CellState::drop);
  EXPECT_EQ(grid.ground[0], -40);
  EXPECT_EQ(grid.state[1], CellState::unknown);
}

TEST(GridMessage, OneThatContradictsItselfIsRefused) {
  const std::vector<std::function<void(grid_t&)>> faults = {
      [](grid_t& grid) { grid.columns = 3; },
      [](grid_t& grid) { grid.columns = grid.rows = 65536; },
      [](grid_t& grid) { grid.columns = grid.rows = -1; },
      [](grid_t& grid) { grid.cell_size = 0; },
      [](grid_t& grid) { grid.origin[1] = std::numeric_limits<double>::quiet_NaN(); },
      [](grid_t& grid) { grid.p[2] = std::numeric_limits<double>::infinity(); }};
  for (const auto& spoil : faults) {
    grid_t message = two_cell_grid();
    spoil(message);
    ObstacleGrid grid;
    EXPECT_FALSE(from_message(message, grid));
    EXPECT_TRUE(grid.empty());
  }
}

TEST(GridMessage, ACellOfNoKnownStateIsUnknown) {
  grid_t message = two_cell_grid();
  message.state[0] = 200;
  ObstacleGrid grid;
  ASSERT_TRUE(from_message(message, grid));
  EXPECT_EQ(grid.state[0], CellState::unknown);
  EXPECT_EQ(grid.ground[0], ObstacleGrid::kNoGround);
}

}  // namespace
}  // namespace scree
