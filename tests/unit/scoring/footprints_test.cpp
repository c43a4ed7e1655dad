#include "scoring/footprints.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {
namespace {

Outline rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

TEST(Footprints, DistanceIsZeroInsideAndExactOutside) {
  const Outline square = rectangle(0, 0, 2, 2);
  EXPECT_EQ(distance_to(square, {1, 1}), 0);
  EXPECT_EQ(distance_to(square, {2, 1}), 0);
  EXPECT_NEAR(distance_to(square, {2.3, 1}), 0.3, 1e-12);
  EXPECT_NEAR(distance_to(square, {2.3, 2.4}), 0.5, 1e-12);  // of a corner: it grows round
}

TEST(Footprints, DistanceSeesTheNotchOfAConcaveOutline) {
  const Outline bracket = {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  EXPECT_NEAR(distance_to(bracket, {1.5, 2}), 0.5, 1e-12);
  EXPECT_EQ(distance_to(bracket, {1.5, 0.5}), 0);
}

TEST(Footprints, OverlapOfRectangles) {
  const Outline square = rectangle(0, 0, 2, 2);
  EXPECT_NEAR(intersection_over_union(square, square), 1, 1e-12);
  EXPECT_NEAR(intersection_over_union(square, rectangle(1, 0, 3, 2)), 2.0 / 6, 1e-12);
  EXPECT_NEAR(intersection_over_union(square, rectangle(0.5, 0.5, 1, 1)), 0.25 / 4, 1e-12);
  EXPECT_EQ(intersection_over_union(square, rectangle(2, 0, 3, 1)), 0);
  EXPECT_EQ(intersection_over_union(square, rectangle(5, 5, 6, 6)), 0);
}

TEST(Footprints, OverlapDoesNotAskWhichWayRound) {
  Outline square = rectangle(0, 0, 2, 2);
  const Outline other = rectangle(1, 0, 3, 2);
  std::ranges::reverse(square);
  EXPECT_NEAR(intersection_over_union(square, other), 2.0 / 6, 1e-12);
}

TEST(Footprints, ABoxWithoutAreaOverlapsNothing) {
  const Outline square = rectangle(0, 0, 2, 2);
  EXPECT_EQ(intersection_over_union(square, rectangle(1, 1, 1, 1)), 0);
  EXPECT_EQ(intersection_over_union(square, rectangle(0, 1, 2, 1)), 0);
}

TEST(Footprints, OverlapOfManyTurnedBoxesStaysAShare) {
  Outline circle;
  for (int i = 0; i < 36; ++i) {
    const double angle = i * std::numbers::pi / 18;
    circle.emplace_back(std::cos(angle), std::sin(angle));
  }
  for (int i = 0; i < 360; ++i) {
    const double angle = i * std::numbers::pi / 180;
    Outline box = rectangle(-1, -0.4, 1.2, 0.7);
    for (Eigen::Vector2d& corner : box) {
      corner = Eigen::Rotation2Dd(angle) * corner + Eigen::Vector2d(0.3 * angle, 0.1);
    }
    const double share = intersection_over_union(circle, box);
    EXPECT_GE(share, 0);
    EXPECT_LT(share, 1);
    EXPECT_NEAR(share, intersection_over_union(box, circle), 1e-9);
  }
}

TEST(Footprints, ACrossedOutlineBecomesItsHull) {
  const Outline bow = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  EXPECT_EQ(uncrossed(bow).size(), 4U);
  EXPECT_NEAR(intersection_over_union(uncrossed(bow), rectangle(0, 0, 1, 1)), 1, 1e-12);
}

TEST(Footprints, SimpleOutlinesStayAsTheyAre) {
  const Outline square = rectangle(0, 0, 2, 2);
  EXPECT_EQ(uncrossed(square), square);
  Outline closed = square;
  closed.push_back(closed.front());
  EXPECT_EQ(uncrossed(closed), square);
}

TEST(Footprints, AnOutlineWithoutAreaIsEmpty) {
  EXPECT_TRUE(uncrossed({}).empty());
  EXPECT_TRUE(uncrossed({{1, 1}}).empty());
  EXPECT_TRUE(uncrossed({{1, 1}, {2, 2}}).empty());
  EXPECT_TRUE(uncrossed({{1, 1}, {1, 1}, {1, 1}, {1, 1}}).empty());
  EXPECT_TRUE(uncrossed({{0, 0}, {1, 1}, {2, 2}}).empty());
}

TEST(Footprints, WidthIsTheLeast) {
  EXPECT_NEAR(least_width(rectangle(0, 0, 4, 1)), 1, 1e-12);
  Outline turned = rectangle(0, 0, 4, 1);
  for (Eigen::Vector2d& corner : turned) corner = Eigen::Rotation2Dd(0.7) * corner;
  EXPECT_NEAR(least_width(turned), 1, 1e-12);
  const Outline notched = {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  EXPECT_NEAR(least_width(notched), 3, 1e-12);
  EXPECT_EQ(least_width({}), 0);
  EXPECT_EQ(least_width({{1, 1}, {1, 1}}), 0);
}

}  // namespace
}  // namespace scree
