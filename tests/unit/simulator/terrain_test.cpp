#include "simulator/terrain.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "scree/core/pose.hpp"

namespace scree {
namespace {

TerrainSettings quick() {
  TerrainSettings settings;
  settings.size = 24;
  settings.placed_within = 12;
  settings.cell = 0.04;
  return settings;
}

/// Mean height of the ground on the footprint's corners moved outwards, where it is there.
double ground_around(const Terrain& terrain, const TerrainFeature& feature) {
  double sum = 0;
  int count = 0;
  const Eigen::Vector2d center = feature.center.head<2>();
  for (const Eigen::Vector2d& corner : feature.footprint) {
    const Eigen::Vector2d out = center + (corner - center) * (1 + 0.05 / (corner - center).norm());
    sum += terrain.height(out.x(), out.y()) - terrain.relief(out.x(), out.y());
    ++count;
  }
  return sum / count;
}

TEST(Terrain, FeaturesHaveTheHeightAndDepthTheyClaim) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Terrain terrain(quick(), seed);
    int obstacles = 0;
    for (const TerrainFeature& feature : terrain.features()) {
      if (!feature.kind) continue;
      ++obstacles;
      const bool positive = feature.kind == ObstacleKind::positive;
      EXPECT_EQ(positive, feature.height > 0);
      EXPECT_GT(std::abs(feature.height), 0.1);
      EXPECT_LT(feature.height, feature.shape == ShapeKind::pillar ? 1.8 : 1.4);
      EXPECT_GT(feature.height, -1.05);
      double furthest = 0;
      const double ground = ground_around(terrain, feature);
      for (double x = -4; x < 4; x += 0.04) {
        for (double y = -4; y < 4; y += 0.04) {
          const Eigen::Vector2d at = feature.center.head<2>() + Eigen::Vector2d(x, y);
          if (!contains(feature.footprint, at)) continue;
          const double above = terrain.height(at.x(), at.y()) - ground;
          furthest = positive ? std::max(furthest, above) : std::min(furthest, above);
        }
      }
      // The ground under it is neither flat nor level.
      EXPECT_NEAR(furthest, feature.height, 0.15 + 0.2 * std::abs(feature.height))
          << feature.name << " of seed " << seed;
    }
    EXPECT_GE(obstacles, 13) << "seed " << seed;
  }
}

TEST(Terrain, WhatIsNoObstacleStaysUnderItsSlope) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Terrain terrain(quick(), seed);
    for (const TerrainFeature& feature : terrain.features()) {
      if (feature.kind) continue;
      double steepest = 0;
      for (const Eigen::Vector2d& corner : feature.footprint) {
        const Eigen::Vector2d spoke = corner - feature.center.head<2>();
        for (double t = 0; t < 0.99; t += 0.02) {
          const Eigen::Vector2d a = feature.center.head<2>() + t * spoke;
          const Eigen::Vector2d b = feature.center.head<2>() + (t + 0.02) * spoke;
          const double rise = terrain.relief(b.x(), b.y()) - terrain.relief(a.x(), a.y());
          steepest = std::max(steepest, std::abs(rise) / (b - a).norm());
        }
      }
      EXPECT_LT(steepest, std::tan(radians(20))) << feature.name << " of seed " << seed;
      EXPECT_GT(steepest, std::tan(radians(3)));
    }
  }
}

TEST(Terrain, GroundStaysUnderItsSlope) {
  TerrainSettings settings = quick();
  settings.positive = settings.negative = settings.smooth = 0;
  settings.roughness = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Terrain terrain(settings, seed);
    int steep = 0;
    int all = 0;
    for (double x = -11; x < 11; x += 0.1) {
      for (double y = -11; y < 11; y += 0.1, ++all) {
        steep += terrain.normal(x, y).z() < std::cos(radians(15.5)) ? 1 : 0;
      }
    }
    EXPECT_LT(steep, all / 100);
  }
}

TEST(Terrain, FootprintsDoNotOverlap) {
  const Terrain terrain(quick(), 9);
  for (const TerrainFeature& a : terrain.features()) {
    for (const TerrainFeature& b : terrain.features()) {
      if (a.id == b.id) continue;
      for (const Eigen::Vector2d& corner : a.footprint) {
        EXPECT_GT(distance(b.footprint, corner), 0.3) << a.id << " and " << b.id;
      }
    }
  }
}

TEST(Terrain, RobotStandsOnALevelClearSpot) {
  TerrainSettings settings = quick();
  settings.clear_radius = 2;
  settings.level_radius = 1;
  const Terrain terrain(settings, 4);
  EXPECT_NEAR(terrain.height(0, 0), 0, 1e-6);
  for (double angle = 0; angle < 6.3; angle += 0.1) {
    EXPECT_NEAR(terrain.height(0.8 * std::cos(angle), 0.8 * std::sin(angle)), 0, 0.04);
    EXPECT_EQ(terrain.feature_at(1.9 * std::cos(angle), 1.9 * std::sin(angle)), 0);
  }
}

TEST(Terrain, SameSeedSameTerrain) {
  const Terrain a(quick(), 5);
  const Terrain b(quick(), 5);
  const Terrain c(quick(), 6);
  bool differs = false;
  for (std::size_t row = 0; row < a.vertices(); row += 7) {
    for (std::size_t column = 0; column < a.vertices(); ++column) {
      ASSERT_EQ(a.vertex(column, row), b.vertex(column, row));
      differs |= a.vertex(column, row) != c.vertex(column, row);
    }
  }
  EXPECT_TRUE(differs);
}

TEST(Footprint, KnowsInsideAndDistance) {
  const Footprint square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  EXPECT_TRUE(contains(square, {1, 1}));
  EXPECT_FALSE(contains(square, {3, 1}));
  EXPECT_DOUBLE_EQ(distance(square, {1, 1}), 0);
  EXPECT_DOUBLE_EQ(distance(square, {3, 1}), 1);
  EXPECT_DOUBLE_EQ(distance(square, {5, 6}), 5);
  EXPECT_TRUE(std::isinf(distance({}, {0, 0})));
}

}  // namespace
}  // namespace scree
