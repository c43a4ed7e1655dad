#include "simulator/boulders.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulator/terrain.hpp"
#include "unit/simulator/bare_terrain.hpp"

namespace scree {
namespace {

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TEST(Boulder, HasTheProportionsOfScannedRocks) {
  Random random(1);
  std::vector<double> heights, widths;
  for (int i = 0; i < 500; ++i) {
    const Boulder boulder = Boulder::draw({0, 0}, 1, random);
    const double width = 4 * boulder.area() / M_PI;
    widths.push_back(width);
    heights.push_back(boulder.height() / std::sqrt(width));
    EXPECT_NEAR(boulder.top({0, 0}, 0), boulder.height(), 1e-9);
    for (const Eigen::Vector2d& corner : boulder.footprint()) {
      EXPECT_EQ(boulder.top(1.01 * corner, 0), 0);
      EXPECT_GT(boulder.top(0.9 * corner, 0), 0.1 * boulder.height());
      EXPECT_LE(corner.norm(), boulder.reach() + 1e-9);
    }
  }
  EXPECT_NEAR(mean(widths), 0.76, 0.02);
  EXPECT_NEAR(mean(heights), 0.46, 0.02);
}

TEST(Boulder, TheirNumberFallsWithAPowerOfTheirLength) {
  Random random(2);
  int longer_than_half = 0;
  int longer_than_one = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double length = draw_boulder_length(0.2, 2, 2, random);
    EXPECT_GE(length, 0.2);
    EXPECT_LE(length, 2);
    longer_than_half += length > 0.5 ? 1 : 0;
    longer_than_one += length > 1 ? 1 : 0;
  }
  // (1/0.5^2 - 1/2^2) / (1/1^2 - 1/2^2)
  EXPECT_NEAR(static_cast<double>(longer_than_half) / longer_than_one, 5, 0.3);
}

class BoulderField : public testing::TestWithParam<double> {
protected:
  static TerrainSettings settings(double cover) {
    TerrainSettings settings = test::level_terrain();
    settings.cell = 0.05;
    settings.boulder_cover = cover;
    for (double x = -6; x < 6; x += 0.25) settings.corridor.emplace_back(x, 0.1 * x);
    return settings;
  }
};

TEST_P(BoulderField, CoversTheWantedShareAndLeavesTheWayFree) {
  const Terrain terrain(settings(GetParam()), 3);
  int covered = 0;
  int all = 0;
  for (double x = -11; x < 11; x += 0.1) {
    for (double y = -11; y < 11; y += 0.1) {
      double way = 100;
      for (const Eigen::Vector2d& by : terrain.settings().corridor) {
        way = std::min(way, (by - Eigen::Vector2d(x, y)).norm());
      }
      if (way < 0.95) {
        EXPECT_LT(terrain.relief(x, y), 0.12);
      } else if (way > 2) {
        covered += terrain.relief(x, y) > 0.02 ? 1 : 0;
        ++all;
      }
    }
  }
  EXPECT_NEAR(static_cast<double>(covered) / all, GetParam(), 0.12);
}

INSTANTIATE_TEST_SUITE_P(Covers, BoulderField, testing::Values(0.2, 0.4, 0.65));

TEST_F(BoulderField, ThoseOfAThirdOfAMetreAreAskedFor) {
  const Terrain terrain(settings(0.6), 5);
  int asked = 0;
  int overlapping = 0;
  for (const TerrainFeature& a : terrain.features()) {
    if (a.is_small) continue;
    ++asked;
    EXPECT_GE(a.height, 0.3);
    EXPECT_NEAR(terrain.relief(a.center.x(), a.center.y()), a.height, 0.5 * a.height);
    for (const TerrainFeature& b : terrain.features()) {
      overlapping += b.id != a.id && distance(a.footprint, b.footprint) <= 0 ? 1 : 0;
    }
  }
  EXPECT_GT(asked, 10);
  EXPECT_GT(overlapping, asked);
  EXPECT_EQ(obstacle_ids(terrain).size(), static_cast<std::size_t>(asked));
}

}  // namespace
}  // namespace scree
