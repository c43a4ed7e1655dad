#include "simulator/plants.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scoring/footprints.hpp"
#include "simulator/beam.hpp"
#include "simulator/cloud.hpp"
#include "simulator/scene.hpp"
#include "unit/simulator/bare_terrain.hpp"

namespace scree {
namespace {

Terrain planted(const PlantCounts& plants, std::uint64_t seed) {
  TerrainSettings settings = test::level_terrain();
  settings.size = 30;
  settings.cell = 0.1;
  settings.placed_within = 12;
  settings.plants = plants;
  for (double x = -10; x < 10; x += 0.25) settings.corridor.emplace_back(x, 0.2 * x);
  return {settings, seed};
}

TEST(Plants, StandApartAndLeaveTheWayFree) {
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const Terrain terrain = planted({.trees = 0.05, .bushes = 0.05, .hedges = 3}, seed);
    std::map<std::string_view, int> count;
    for (const TerrainFeature& plant : terrain.features()) {
      ++count[plant.name];
      EXPECT_EQ(plant.kind, ObstacleKind::positive);
      EXPECT_EQ(uncrossed(plant.footprint), plant.footprint) << plant.name;
      for (const Eigen::Vector2d& by : terrain.settings().corridor) {
        EXPECT_GE(distance(plant.footprint, by), terrain.settings().corridor_half_width);
      }
      for (const TerrainFeature& other : terrain.features()) {
        if (other.id == plant.id) continue;
        EXPECT_GT(distance(other.footprint, plant.footprint), 0.25);
      }
    }
    EXPECT_GT(count["tree"], 20);
    EXPECT_GT(count["bush"], 20);
    EXPECT_GE(count["hedge"], 1);
  }
}

TEST(Plants, LowOrThinBushesAreNotAskedFor) {
  const Terrain terrain = planted({.bushes = 0.2}, 2);
  int asked = 0;
  int low = 0;
  for (const TerrainFeature& bush : terrain.features()) {
    if (bush.height < 0.5) {
      EXPECT_TRUE(bush.is_small);
      ++low;
    }
    asked += bush.is_small ? 0 : 1;
  }
  EXPECT_GT(asked, 30);
  EXPECT_GT(low, 5);
}

/// Share of level beams through the middle of a thing, this high above the ground, that get
/// through.
double light_through(const Terrain& terrain, const TerrainFeature& thing, double up) {
  Random random(3);
  constexpr int kBeams = 400;
  int through = 0;
  for (int i = 0; i < kBeams; ++i) {
    const double angle = 2 * M_PI * i / kBeams;
    const Eigen::Vector3d way(std::cos(angle), std::sin(angle), 0);
    const Eigen::Vector3d middle(thing.center.x(), thing.center.y(),
                                 terrain.height(thing.center.x(), thing.center.y()) + up);
    through += terrain.volumes().cast(middle - 3 * way, way, 6, random) ? 0 : 1;
  }
  return static_cast<double>(through) / kBeams;
}

TEST(Plants, LightPassesAskedForBushesInPartAndTrunksNotAtAll) {
  const Terrain bushes = planted({.bushes = 0.01}, 4);
  double most = 0;
  double least = 1;
  for (const TerrainFeature& bush : bushes.features()) {
    const bool is_at_border = bush.center.head<2>().cwiseAbs().maxCoeff() > 11;
    if (bush.is_small || is_at_border) continue;
    const double light = light_through(bushes, bush, 0.4 * bush.height);
    most = std::max(most, light);
    least = std::min(least, light);
  }
  EXPECT_LT(most, 0.75);
  EXPECT_LT(least, 0.2);
  EXPECT_GT(most, 0.05);
  const Terrain trees = planted({.trees = 0.01}, 4);
  int single = 0;
  for (const TerrainFeature& tree : trees.features()) {
    const auto trunks = std::ranges::count_if(trees.volumes().all(), [&](const Volume& volume) {
      return volume.part == tree.first_part && volume.density == Volume::kSolid;
    });
    const bool is_at_border = tree.center.head<2>().cwiseAbs().maxCoeff() > 11;
    if (trunks > 1 || is_at_border) continue;
    EXPECT_EQ(light_through(trees, tree, 0.05), 0);
    ++single;
  }
  EXPECT_GE(single, 3);
}

TEST(Plants, ACrownHighAboveLetsLightReachTheGround) {
  const Terrain terrain = planted({.trees = 0.02}, 5);
  Random random(1);
  int below = 0;
  int at_ground = 0;
  for (const TerrainFeature& tree : terrain.features()) {
    for (const Volume& lobe : terrain.volumes().all()) {
      if (lobe.part != tree.first_part || lobe.form != Volume::Form::ellipsoid) continue;
      if (lobe.center.z() - lobe.half.z() < 1.5) continue;
      // From above, straight down through one lobe or several.
      for (int i = 0; i < 50; ++i) {
        const Eigen::Vector3d above(lobe.center.x() + 0.3, lobe.center.y() + 0.3, 15);
        at_ground += terrain.volumes().cast(above, {0, 0, -1}, 15.2, random) ? 0 : 1;
        ++below;
      }
    }
  }
  ASSERT_GT(below, 100);
  EXPECT_GT(at_ground, below / 20);
  EXPECT_LT(at_ground, below * 9 / 10);
}

TEST(Plants, HitsAreOfThePlantUpToTwoMetres) {
  const Terrain terrain = planted({.trees = 0.004}, 6);
  ASSERT_FALSE(terrain.features().empty());
  const TerrainFeature& tree = terrain.features()[0];
  const RayCaster caster(terrain);
  Beam beam(terrain, caster, 80);
  Random random(1);
  const Eigen::Vector3d foot(tree.center.x(), tree.center.y(),
                             terrain.height(tree.center.x(), tree.center.y()));
  for (const double up : {1.0, 2.3}) {
    const Eigen::Vector3d origin = foot + Eigen::Vector3d(-3, 0, up);
    const auto& echoes = beam.cast(origin, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, random);
    ASSERT_FALSE(echoes.empty());
    EXPECT_EQ(echoes[0].part, up < 2 ? tree.first_part : 0U);
  }
}

TEST(Plants, TallGrassIsNoObstacleAndLeavesATrack) {
  const Terrain terrain = planted({.tall_grass = 0.5}, 7);
  EXPECT_TRUE(terrain.features().empty());
  EXPECT_GT(terrain.volumes().all().size(), 500U);
  double tallest = 0;
  for (const Volume& grass : terrain.volumes().all()) {
    tallest = std::max(tallest, grass.half.z());
    for (const Eigen::Vector2d& by : terrain.settings().corridor) {
      EXPECT_GT((by - grass.center.head<2>()).norm(), 0.35);
    }
  }
  EXPECT_GT(tallest, 0.3);
  EXPECT_LE(tallest, 1);
}

TEST(Plants, AReconstructedCloudHasThem) {
  const Terrain terrain = planted({.trees = 0.03, .bushes = 0.05}, 8);
  CloudSettings settings;
  settings.points = 50'000;
  const PointCloud cloud = reconstructed_cloud(terrain, settings, 8);
  int high = 0;
  int on_ground = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    high += cloud.z[i] > 0.5F ? 1 : 0;
    on_ground += std::abs(cloud.z[i]) < 0.1F ? 1 : 0;
  }
  EXPECT_GT(high, 5'000);
  EXPECT_GT(on_ground, 15'000);
}

}  // namespace
}  // namespace scree
