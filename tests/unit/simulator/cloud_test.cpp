#include "simulator/cloud.hpp"
#include "simulator/bare_terrain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace scree {
namespace {

TEST(ReconstructedCloud, LiesOnTheTerrainAndCoversWalls) {
  TerrainSettings settings;
  settings.size = 24;
  settings.placed_within = 12;
  const Terrain terrain(settings, 2);
  CloudSettings cloud_settings;
  cloud_settings.points = 200'000;
  const PointCloud cloud = reconstructed_cloud(terrain, cloud_settings, 2);
  ASSERT_EQ(cloud.size(), cloud_settings.points);
  std::size_t far = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double ground =
        terrain.height(static_cast<double>(cloud.x[i]), static_cast<double>(cloud.y[i]));
    far += std::abs(static_cast<double>(cloud.z[i]) - ground) > 0.15 ? 1U : 0U;
    EXPECT_LE(std::abs(cloud.x[i]), 12.1F);
  }
  EXPECT_GT(far, 50U);    // scattered points
  EXPECT_LT(far, 3000U);  // these, and noise across the edges of walls
}

TEST(ReconstructedCloud, SameSeedSameBytes) {
  TerrainSettings settings;
  settings.size = 10;
  settings.placed_within = 5;
  const Terrain terrain(settings, 2);
  CloudSettings cloud_settings;
  cloud_settings.points = 5000;
  const PointCloud a = reconstructed_cloud(terrain, cloud_settings, 2);
  const PointCloud b = reconstructed_cloud(terrain, cloud_settings, 2);
  const PointCloud c = reconstructed_cloud(terrain, cloud_settings, 3);
  EXPECT_TRUE(std::equal(a.z.begin(), a.z.end(), b.z.begin()));
  EXPECT_FALSE(std::equal(a.z.begin(), a.z.end(), c.z.begin()));
}

/// Points in each square metre of a terrain 24 m across.
std::vector<int> counts(const PointCloud& cloud) {
  std::vector<int> counts(24 * 24);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const int column = static_cast<int>(std::clamp(cloud.x[i] + 12, 0.0F, 23.9F));
    const int row = static_cast<int>(std::clamp(cloud.y[i] + 12, 0.0F, 23.9F));
    ++counts[static_cast<std::size_t>(row * 24 + column)];
  }
  std::sort(counts.begin(), counts.end());
  return counts;
}

TEST(ReconstructedCloud, IsDenserInSomePlaces) {
  TerrainSettings settings = test::bare_terrain(24);
  settings.cell = 0.05;
  const Terrain terrain(settings, 2);
  CloudSettings cloud_settings;
  cloud_settings.points = 200'000;
  const auto uneven = counts(reconstructed_cloud(terrain, cloud_settings, 2));
  EXPECT_GT(uneven[570], 1.8 * uneven[5]);
  EXPECT_LT(uneven[570], 4 * uneven[5]);
  cloud_settings.density_spread = 1;
  const auto even = counts(reconstructed_cloud(terrain, cloud_settings, 2));
  EXPECT_LT(even[570], 1.4 * even[5]);
}

TEST(ReconstructedCloud, TuftsArePointsAboveTheGround) {
  TerrainSettings settings = test::bare_terrain(24);
  settings.cell = 0.05;
  settings.tuft_cover = 0.3;
  const Terrain terrain(settings, 2);
  CloudSettings cloud_settings;
  cloud_settings.points = 50'000;
  const PointCloud cloud = reconstructed_cloud(terrain, cloud_settings, 2);
  int above = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto x = static_cast<double>(cloud.x[i]);
    const auto y = static_cast<double>(cloud.y[i]);
    above += static_cast<double>(cloud.z[i]) - terrain.height(x, y) > 0.06 ? 1 : 0;
  }
  EXPECT_GT(above, 500);
  EXPECT_LT(above, 15'000);
}

}  // namespace
}  // namespace scree
