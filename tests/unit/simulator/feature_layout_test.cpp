#include "simulator/feature_layout.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

Footprint footprint_of(const PlacedShape& placed) {
  Footprint footprint = placed.shape.footprint();
  for (Eigen::Vector2d& corner : footprint) corner += placed.center;
  return footprint;
}

bool is_obstacle(const PlacedShape& placed) {
  return is_positive(placed.shape.kind()) || is_negative(placed.shape.kind());
}

TEST(FeatureLayout, PairsAreCloseAndKnowEachOther) {
  TerrainSettings settings;
  settings.pairs = 4;
  settings.neighbours = 2;
  int close = 0;
  int closest = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto placed = lay_out_features(settings, seed);
    for (std::size_t i = 0; i < placed.size(); ++i) {
      if (placed[i].partner < 0) continue;
      const auto other = static_cast<std::size_t>(placed[i].partner);
      ASSERT_LT(other, placed.size());
      EXPECT_EQ(static_cast<std::size_t>(placed[other].partner), i);
      EXPECT_TRUE(is_obstacle(placed[i]));
      const double gap = distance(footprint_of(placed[i]), footprint_of(placed[other]));
      EXPECT_GE(gap, 0.299);
      EXPECT_LE(gap, 0.601);
      ++close;
      closest += gap < 0.34 ? 1 : 0;
    }
  }
  EXPECT_GE(close, 8 * 2 * 5);
  EXPECT_GE(closest, 8);
}

TEST(FeatureLayout, AllOthersKeepTheirGap) {
  TerrainSettings settings;
  settings.small = 20;
  const auto placed = lay_out_features(settings, 3);
  EXPECT_GE(placed.size(), 40U);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (placed[i].partner == static_cast<int>(k)) continue;
      EXPECT_GE(distance(footprint_of(placed[i]), footprint_of(placed[k])), settings.gap - 1e-9);
    }
  }
}

TEST(FeatureLayout, NestsLieInHollowsAndOnMounds) {
  TerrainSettings settings;
  settings.pairs = 0;
  settings.nests = 6;
  int nested = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto placed = lay_out_features(settings, seed);
    for (std::size_t i = 1; i < placed.size(); ++i) {
      if (is_obstacle(placed[i]) && !is_obstacle(placed[i - 1]) &&
          contains(footprint_of(placed[i - 1]), placed[i].center)) {
        ++nested;
      }
    }
  }
  EXPECT_GE(nested, 20);
}

TEST(FeatureLayout, CorridorStaysFreeOfObstacles) {
  TerrainSettings settings;
  settings.small = 20;
  settings.placed_within = 8;
  for (int i = 0; i < 60; ++i) {
    settings.corridor.emplace_back(0.25 * i - 8, std::sin(0.2 * i));
  }
  const auto placed = lay_out_features(settings, 5);
  int obstacles = 0;
  for (const PlacedShape& shape : placed) {
    if (!is_obstacle(shape)) continue;
    ++obstacles;
    const Footprint footprint = footprint_of(shape);
    double nearest = 1e9;
    for (const Eigen::Vector2d& by : settings.corridor) {
      nearest = std::min(nearest, distance(footprint, by));
    }
    EXPECT_GE(nearest, settings.corridor_half_width);
    EXPECT_LE(nearest, settings.placed_within);
  }
  EXPECT_GE(obstacles, 30);
}

}  // namespace
}  // namespace scree
