#include "scree/detect/enclosing_polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "allocation_counter.hpp"

namespace scree {
namespace {

using Eigen::Vector2d;
using Places = std::vector<Vector2d>;

double area(const ConvexPolygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

/// Turns left at every corner.
bool is_convex(const ConvexPolygon& polygon) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    const Vector2d in = b - polygon[i], out = polygon[(i + 2) % polygon.size()] - b;
    if (in.x() * out.y() - in.y() * out.x() <= 0) return false;
  }
  return polygon.has_area();
}

/// Farthest that a place lies outside.
double outside(const ConvexPolygon& polygon, const Places& places) {
  double most = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d along = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
    for (const Vector2d& place : places) {
      const Vector2d to = place - polygon[i];
      most = std::max(most, along.y() * to.x() - along.x() * to.y());
    }
  }
  return most;
}

/// Of a copy of the places.
ConvexPolygon polygon_around(Places places) {
  return enclosing_polygon(places);
}

Places circle(int corners, double radius) {
  Places places;
  for (int i = 0; i < corners; ++i) {
    const double angle = i * 2 * std::numbers::pi / corners;
    places.emplace_back(5 + radius * std::cos(angle), -3 + radius * std::sin(angle));
  }
  return places;
}

TEST(EnclosingPolygon, OfNothingIsEmpty) {
  EXPECT_TRUE(polygon_around({}).empty());
}

TEST(EnclosingPolygon, IsTheHullWhereThatHasFewCorners) {
  Places places = {{0, 0}, {2, 0}, {2, 1}, {0, 1}, {1, 0.5}, {1, 0}, {2, 0.5}, {0, 0}};
  const ConvexPolygon polygon = polygon_around(places);
  ASSERT_EQ(polygon.size(), 4U);
  EXPECT_TRUE(is_convex(polygon));
  EXPECT_DOUBLE_EQ(area(polygon), 2);
  EXPECT_EQ(outside(polygon, places), 0);
}

TEST(EnclosingPolygon, HoldsEveryPlaceWithAtMostSixteenCorners) {
  std::mt19937 random(3);
  std::normal_distribution<double> spread(0, 1);
  for (int round = 0; round < 200; ++round) {
    Places places;
    for (int i = 0; i < 5 + 20 * round; ++i) {
      places.emplace_back(100 + spread(random), 3 * spread(random));
    }
    const ConvexPolygon polygon = polygon_around(places);
    ASSERT_LE(polygon.size(), ConvexPolygon::kMaxCorners);
    ASSERT_TRUE(is_convex(polygon)) << round;
    ASSERT_LT(outside(polygon, places), 1e-9) << round;
  }
}

TEST(EnclosingPolygon, AddsLittleAreaWhereItLeavesOutEdges) {
  for (const int corners : {17, 32, 100, 5000}) {
    const Places places = circle(corners, 2);
    const ConvexPolygon polygon = polygon_around(places);
    EXPECT_EQ(polygon.size(), ConvexPolygon::kMaxCorners);
    EXPECT_LT(outside(polygon, places), 1e-9);
    const double exact = corners / 2.0 * 4 * std::sin(2 * std::numbers::pi / corners);
    EXPECT_LT(area(polygon), 1.05 * exact) << corners;
  }
}

TEST(EnclosingPolygon, KeepsTheLongEdgesOfARectangleWithRoundCorners) {
  Places places;
  for (int i = 0; i < 40; ++i) {
    const double angle = (i + 0.5) * std::numbers::pi / 20;
    places.emplace_back(std::copysign(3, std::cos(angle)) + 0.2 * std::cos(angle),
                        std::copysign(1, std::sin(angle)) + 0.2 * std::sin(angle));
  }
  const ConvexPolygon polygon = polygon_around(places);
  EXPECT_LE(polygon.size(), ConvexPolygon::kMaxCorners);
  EXPECT_LT(outside(polygon, places), 1e-9);
  EXPECT_LT(area(polygon), 6.4 * 2.4);
}

TEST(EnclosingPolygon, IsTwoCentimetresWideAroundWhatHasNoWidth) {
  const Places point = {{1, 2}}, twice = {{1, 2}, {1, 2}}, pair = {{1, 2}, {4, 6}};
  const Places line = {{0, 0}, {3, 3}, {1, 1}, {2, 2}}, sliver = {{0, 0}, {2, 0.001}, {4, 0}};
  for (const Places& places : {point, twice, pair, line, sliver}) {
    const ConvexPolygon polygon = polygon_around(places);
    ASSERT_EQ(polygon.size(), 4U);
    EXPECT_TRUE(is_convex(polygon));
    EXPECT_LT(outside(polygon, places), 1e-9);
    const double first = (polygon[1] - polygon[0]).norm(), other = (polygon[2] - polygon[1]).norm();
    EXPECT_NEAR(std::min(first, other), 0.02, 1e-9);
  }
  EXPECT_NEAR(area(polygon_around(pair)), 0.1, 1e-9);
}

TEST(EnclosingPolygon, IsTheSameForPlacesInAnyOrder) {
  Places places = circle(50, 1);
  const ConvexPolygon polygon = polygon_around(places);
  std::ranges::shuffle(places, std::mt19937(1));
  const ConvexPolygon other = polygon_around(places);
  ASSERT_EQ(polygon.size(), other.size());
  for (std::size_t i = 0; i < polygon.size(); ++i) EXPECT_EQ(polygon[i], other[i]);
}

TEST(EnclosingPolygon, OfTwoPolygonsHoldsBothAndIsUnknownWhereOneIs) {
  const Places first = circle(16, 1);
  Places second = first;
  for (Vector2d& place : second) place += Vector2d(3, 1);
  const ConvexPolygon a = polygon_around(first), b = polygon_around(second);
  const ConvexPolygon both = enclosing_polygon(a, b);
  EXPECT_TRUE(is_convex(both));
  EXPECT_LT(outside(both, first), 1e-9);
  EXPECT_LT(outside(both, second), 1e-9);
  EXPECT_TRUE(enclosing_polygon(a, ConvexPolygon()).empty());
  EXPECT_TRUE(enclosing_polygon(ConvexPolygon(), b).empty());
}

TEST(EnclosingPolygons, TakesTheGivenPointsOfACloudAndAllocatesNothing) {
  PointCloud cloud(100);
  for (int i = 0; i < 100; ++i) {
    const auto at = static_cast<float>(i);
    cloud.push_back(at, at * (99 - at), 7, 0);
  }
  std::vector<std::uint32_t> indices(50);
  std::iota(indices.begin(), indices.end(), 50U);
  EnclosingPolygons polygons(50);
  const std::size_t before = test::allocations();
  const ConvexPolygon polygon = polygons.around(cloud, indices);
  EXPECT_EQ(test::allocations(), before);
  double left = polygon[0].x(), right = left;
  for (const Vector2d& corner : polygon) {
    left = std::min(left, corner.x());
    right = std::max(right, corner.x());
  }
  EXPECT_NEAR(left, 50, 1);
  EXPECT_NEAR(right, 99, 1);
}

}  // namespace
}  // namespace scree
