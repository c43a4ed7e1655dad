#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "live/top_page.hpp"

namespace scree::cli {
namespace {

Obstacle obstacle(ObstacleKind kind, double x, double y) {
  Obstacle one;
  one.kind = kind;
  one.center = {x, y, 0};
  return one;
}

TEST(TopPlot, SightingsAreInTheRobotsFrameNearestFirst) {
  ObstacleList list(3);
  // The robot at (10, -4) looks along the y axis of `odom`.
  list.pose.translation = {10, -4, 1};
  list.pose.rotation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  list.obstacles.push_back(obstacle(ObstacleKind::positive, 10, 4));
  list.obstacles.push_back(obstacle(ObstacleKind::negative, 7, -4));
  const auto all = sightings(list);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].obstacle, &list.obstacles[1]);
  EXPECT_NEAR(all[0].ahead, 0, 1e-9);
  EXPECT_NEAR(all[0].left, 3, 1e-9);
  EXPECT_NEAR(all[0].distance, 3, 1e-9);
  EXPECT_NEAR(all[1].ahead, 8, 1e-9);
  EXPECT_NEAR(all[1].left, 0, 1e-9);
}

TEST(TopPlot, ForwardIsUpAndLeftIsLeft) {
  ObstacleList list(4);
  for (const auto& [kind, x, y] :
       {std::tuple{ObstacleKind::positive, 6.0, 0.0}, std::tuple{ObstacleKind::negative, 3.0, 2.0},
        std::tuple{ObstacleKind::positive, -1.0, -3.0}}) {
    list.obstacles.push_back(obstacle(kind, x, y));
  }
  // The robot stands in row 6 of 9, so that a row is a metre and a column half a metre.
  const auto page = plot(sightings(list), 6, 9, 17);
  ASSERT_EQ(page.size(), 9U);
  EXPECT_EQ(page[0], "        #        ");
  EXPECT_EQ(page[3], "    O            ");
  EXPECT_EQ(page[6], "        ^        ");
  EXPECT_EQ(page[7], "              #  ");
  EXPECT_EQ(page[1][8], '.') << "5 m ahead";
}

TEST(TopPlot, WhatIsTooFarOrNoNumberIsLeftOut) {
  ObstacleList list(3);
  list.obstacles.push_back(obstacle(ObstacleKind::positive, 1e30, 0));
  list.obstacles.push_back(obstacle(ObstacleKind::positive, std::nan(""), 0));
  list.obstacles.push_back(obstacle(ObstacleKind::positive, 0, -40));
  for (const std::string& line : plot(sightings(list), 6, 9, 17)) {
    EXPECT_EQ(line.find('#'), std::string::npos);
  }
  EXPECT_TRUE(plot({}, 6, 0, 17).empty());
  EXPECT_EQ(plot({}, 6, 1, 1), std::vector<std::string>{"^"});
}

}  // namespace
}  // namespace scree::cli
