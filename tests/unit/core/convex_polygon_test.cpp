#include "scree/core/convex_polygon.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "scree/core/obstacle.hpp"

namespace scree {
namespace {

ConvexPolygon square() {
  ConvexPolygon polygon;
  for (const auto& [x, y] : {std::pair{0, 0}, {2, 0}, {2, 2}, {0, 2}}) polygon.push_back({x, y});
  return polygon;
}

TEST(ConvexPolygon, TakesUpToItsMostCorners) {
  ConvexPolygon polygon;
  for (std::size_t i = 0; i < ConvexPolygon::kMaxCorners; ++i) {
    EXPECT_TRUE(polygon.push_back({static_cast<double>(i), 0}));
  }
  EXPECT_FALSE(polygon.push_back({99, 0}));
  EXPECT_EQ(polygon.size(), ConvexPolygon::kMaxCorners);
  EXPECT_EQ(polygon[15].x(), 15);
}

TEST(ConvexPolygon, ContainsItsInsideAndItsBoundary) {
  const ConvexPolygon polygon = square();
  EXPECT_TRUE(polygon.contains({1, 1}));
  EXPECT_TRUE(polygon.contains({2, 1}));
  EXPECT_FALSE(polygon.contains({2.01, 1}));
  EXPECT_FALSE(polygon.contains({1, -0.01}));
}

TEST(ConvexPolygon, WithoutAreaContainsNothing) {
  ConvexPolygon polygon;
  EXPECT_FALSE(polygon.contains({0, 0}));
  polygon.push_back({0, 0});
  polygon.push_back({1, 0});
  EXPECT_FALSE(polygon.contains({0.5, 0}));
}

TEST(Obstacle, MovesWithItsFootprintIntoTheParentFrame) {
  Obstacle obstacle;
  obstacle.center = {1, 1, 3};
  obstacle.footprint = square();
  const Pose child{{10, 20, 30}, from_roll_pitch_yaw(0, std::numbers::pi / 2, 0)};
  move_into_parent(child, obstacle);
  EXPECT_TRUE(obstacle.center.isApprox(Eigen::Vector3d(13, 21, 29)));
  // At the height of the centre, x becomes -z and z becomes x.
  EXPECT_TRUE(obstacle.footprint[1].isApprox(Eigen::Vector2d(13, 20)));
  EXPECT_TRUE(obstacle.footprint[2].isApprox(Eigen::Vector2d(13, 22)));
}

TEST(Evidence, HasAWordForEach) {
  EXPECT_STREQ(name(Evidence::none), "none");
  EXPECT_STREQ(name(Evidence::inside), "inside");
  EXPECT_STREQ(name(Evidence::wall), "wall");
  EXPECT_STREQ(name(Evidence::edge), "edge");
  EXPECT_STREQ(name(Evidence::shadow), "shadow");
}

}  // namespace
}  // namespace scree
