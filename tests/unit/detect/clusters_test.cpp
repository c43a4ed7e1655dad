#include "scree/detect/clusters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "allocation_counter.hpp"
#include "scree/detect/ground_height.hpp"
#include "scree/detect/label.hpp"

namespace scree {
namespace {

/// Points on the flank of a round bump (height above zero) or bowl, with the slope they lie on.
CandidatePoints flank(float height, float radius) {
  CandidatePoints edges(360);
  PointCloud one(1);
  for (int degree = 0; degree < 360; ++degree) {
    const float angle = static_cast<float>(degree) * std::numbers::pi_v<float> / 180;
    const float share = 0.3F + 0.6F * static_cast<float>(degree % 7) / 7;  // of the radius
    one.clear();
    one.push_back(radius * share * std::cos(angle), radius * share * std::sin(angle),
                  height * (1 - share), 10);
    const float slope = -height / radius;  // outward
    edges.push_back(one, 0, slope * std::cos(angle), slope * std::sin(angle), one.z[0]);
  }
  return edges;
}

std::vector<std::uint32_t> all_of(const CandidatePoints& edges) {
  std::vector<std::uint32_t> indices(edges.size());
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

TEST(Features, AnglesAreAcuteOnABumpAndObtuseInABowl) {
  const CandidatePoints bump = flank(0.5F, 1), bowl = flank(-0.5F, 1);
  const Features of_bump = measure(bump, all_of(bump));
  EXPECT_EQ(of_bump[acute_count], 360);
  EXPECT_EQ(of_bump[obtuse_count], 0);
  const Features of_bowl = measure(bowl, all_of(bowl));
  EXPECT_EQ(of_bowl[acute_count], 0);
  EXPECT_EQ(of_bowl[obtuse_count], 360);
}

TEST(Features, HeightsAreAboveTheGroundNotTheOrigin) {
  CandidatePoints bump = flank(0.5F, 1);
  for (float& z : bump.points.z) z += 10;
  const Features features = measure(bump, all_of(bump));
  EXPECT_NEAR(features[max_height], 0.35, 1e-4);
  EXPECT_NEAR(features[min_height], 0.5 * (1 - 0.3 - 0.6 * 6 / 7), 1e-4);
  EXPECT_GT(features[mean_height], features[min_height]);
  EXPECT_LT(features[mean_height], features[max_height]);
}

TEST(OrientedBox, IsFoundAtEveryAngle) {
  for (int degree = -89; degree <= 90; degree += 7) {
    const double yaw = degree * std::numbers::pi / 180;
    PointCloud cloud(4);
    for (const auto& [u, v] : {std::pair{2.0, 0.5}, {2.0, -0.5}, {-2.0, 0.5}, {-2.0, -0.5}}) {
      cloud.push_back(static_cast<float>(7 + u * std::cos(yaw) - v * std::sin(yaw)),
                      static_cast<float>(-3 + u * std::sin(yaw) + v * std::cos(yaw)), 0, 0);
    }
    const std::vector<std::uint32_t> all{0, 1, 2, 3};
    const OrientedBox box = smallest_box(cloud, all);
    EXPECT_NEAR(box.length, 4, 1e-3);
    EXPECT_NEAR(box.width, 1, 1e-3);
    EXPECT_NEAR(box.center_x, 7, 1e-3);
    EXPECT_NEAR(box.center_y, -3, 1e-3);
    EXPECT_NEAR(std::cos(box.yaw - yaw), 1, 1e-4);
    EXPECT_GT(double{box.yaw}, -std::numbers::pi / 2);
    EXPECT_LE(double{box.yaw}, std::numbers::pi / 2);
    EXPECT_NEAR(box.distances()(7, -3), 0, 1e-6);
    EXPECT_NEAR(box.distances()(static_cast<float>(7 + 3 * std::cos(yaw)),
                                static_cast<float>(-3 + 3 * std::sin(yaw))),
                1, 1e-3);
  }
}

TEST(OrientedBox, OfOnePointIsThePoint) {
  PointCloud cloud(1);
  cloud.push_back(1, 2, 3, 0);
  const std::vector<std::uint32_t> one{0};
  const OrientedBox box = smallest_box(cloud, one);
  EXPECT_EQ(box.length, 0);
  EXPECT_EQ(box.center_x, 1);
  EXPECT_EQ(box.center_y, 2);
}

TEST(Clusters, GathersLabelsOfEnoughUnits) {
  const CandidatePoints edges = flank(0.5F, 1);
  std::vector<std::uint32_t> labels(edges.size());
  for (std::uint32_t i = 0; i < labels.size(); ++i) labels[i] = i % 10 == 0 ? kNoLabel : i % 3;
  const std::vector<std::uint32_t> sizes{5, 1, 3};
  Clusters clusters(edges.size());
  clusters.gather(edges, labels, sizes, 3);
  ASSERT_EQ(clusters.all().size(), 2U);
  for (const Cluster& cluster : clusters.all()) {
    const std::uint32_t label = labels[clusters.members(cluster)[0]];
    EXPECT_EQ(cluster.size, sizes[label]);
    EXPECT_EQ(clusters.members(cluster).size(),
              static_cast<std::size_t>(std::ranges::count(labels, label)));
    for (const std::uint32_t i : clusters.members(cluster)) EXPECT_EQ(labels[i], label);
  }
}

/// Level ground at z = 1, a metre-wide box of rock points at z = 3, and one far rock.
struct Yard {
  PointCloud cloud{4000};
  std::vector<std::uint8_t> is_edge;
  PlaneCells cells{4000};

  explicit Yard(float spacing) {
    const int steps = static_cast<int>(4 / spacing);
    for (int row = -steps; row <= steps; ++row) {
      for (int column = -steps; column <= steps; ++column) {
        const float x = static_cast<float>(column) * spacing, y = static_cast<float>(row) * spacing;
        const bool rock = std::abs(x) < 0.5F && std::abs(y) < 0.5F;
        cloud.push_back(x, y, rock ? 3 : 1, 0);
      }
    }
    cells.build(cloud, 0.3F);
    for (const float z : cells.points().z) is_edge.push_back(z > 2 ? 1 : 0);
  }
};

TEST(GroundHeight, IsTheMedianOfTheRingWithoutEdges) {
  Yard yard(0.15F);
  GroundHeight ground(0.1F, 0.6F, 4000);
  OrientedBox box;
  box.length = box.width = 1;
  EXPECT_EQ(ground.around(box, yard.cells, yard.is_edge, -7), 1);
}

TEST(GroundHeight, WidensAnEmptyRingAndSaysWhenThereIsNoGround) {
  Yard yard(0.15F);
  GroundHeight ground(0.1F, 0.6F, 4000);
  OrientedBox far;
  far.center_x = 5.5F;
  EXPECT_EQ(ground.around(far, yard.cells, yard.is_edge, -7), 1);
  far.center_x = 1000;
  EXPECT_EQ(ground.around(far, yard.cells, yard.is_edge, -7), -7);
}

TEST(Clusters, AnObstacleAroundAPlaceIsPartedIntoQuartersWithoutAllocating) {
  const CandidatePoints ring = flank(0.5F, 2);
  Clusters clusters(360);
  const std::vector<std::uint32_t> labels(360, 0), sizes = {360};
  clusters.gather(ring, labels, sizes, 1);
  const std::size_t before = test::allocations();
  clusters.part_around({0.1F, 0}, ring.points, 4);
  EXPECT_EQ(test::allocations(), before);
  ASSERT_EQ(clusters.all().size(), 4U);
  std::size_t points = 0;
  for (const Cluster& part : clusters.all()) {
    EXPECT_GE(part.box.distances()(0.1F, 0), 0);
    points += part.end - part.begin;
  }
  EXPECT_EQ(points, 360U);
}

/// Points each 0.1 m on the two arms of a corner at the origin, `height` above the ground.
CandidatePoints corner(float arm, float height) {
  CandidatePoints points(1000);
  PointCloud cloud(1000);
  for (int i = 0; i < static_cast<int>(10 * arm); ++i) {
    const float way = 0.1F * static_cast<float>(i);
    cloud.push_back(way, 0, height, 0);
    cloud.push_back(0, way, height, 0);
  }
  for (std::size_t i = 0; i < cloud.size(); ++i) points.push_back(cloud, i, 0, 0, height);
  return points;
}

std::size_t parts_of(const CandidatePoints& points, Clusters& clusters) {
  const auto size = static_cast<std::uint32_t>(points.size());
  const std::vector<std::uint32_t> labels(size, 0), sizes = {size};
  clusters.gather(points, labels, sizes, 1);
  const std::size_t before = test::allocations();
  clusters.part_bent(points, 4);
  EXPECT_EQ(test::allocations(), before);
  return clusters.all().size();
}

TEST(Clusters, AWallAroundACornerIsTwoWalls) {
  const CandidatePoints wall = corner(8, 0.5F);
  Clusters clusters(1000);
  ASSERT_EQ(parts_of(wall, clusters), 2U);
  for (const Cluster& part : clusters.all()) {
    EXPECT_LT(part.box.width, 1.1F);
    EXPECT_GT(part.box.length, 6.5F);
  }
}

TEST(Clusters, WhatIsShortOrFilledOrBelowStaysWhole) {
  Clusters clusters(1000);
  EXPECT_EQ(parts_of(corner(2, 0.5F), clusters), 1U);
  EXPECT_EQ(parts_of(corner(8, -0.5F), clusters), 1U) << "the rim of a pit";
  EXPECT_EQ(parts_of(flank(3, 4), clusters), 1U) << "a heap";
}

}  // namespace
}  // namespace scree
