#include "training/data_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "simulator/scene.hpp"
#include "training/worlds.hpp"

namespace scree {
namespace {

/// What differs between the terrains of two scenes.
auto facts(const TerrainSettings& settings) {
  return std::tuple(settings.size, settings.placed_within, settings.gentlest_slope_deg,
                    settings.steepest_slope_deg, settings.roughness, settings.unevenness,
                    settings.tuft_cover, settings.positive, settings.negative, settings.smooth,
                    settings.small, settings.pairs, settings.neighbours, settings.nests,
                    settings.weights);
}

auto facts(const CloudSettings& settings) {
  return std::tuple(settings.points, settings.noise, settings.scattered_share,
                    settings.density_spread, settings.rim_density, settings.wall_density,
                    settings.ghosting, settings.unseen_patches);
}

TEST(VariedTerrain, TheSameSeedTheSameAndAnotherAnother) {
  std::set<decltype(facts(TerrainSettings()))> all;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    EXPECT_EQ(facts(varied_terrain(seed)), facts(varied_terrain(seed)));
    all.insert(facts(varied_terrain(seed)));
  }
  // Only the crowded terrain of the default kind comes again; its seed tells two of them apart.
  const std::size_t crowded = 40 / (kScenes.size() + 1);
  EXPECT_EQ(all.size(), 40U - (crowded - 1));
}

TEST(VariedTerrain, HasEveryScene) {
  for (const Scene scene : kScenes) {
    int times = 0;
    for (std::uint64_t seed = 100; seed < 100 + kScenes.size() + 1; ++seed) {
      times += facts(varied_terrain(seed)) == facts(cloud_terrain(scene, seed)) ? 1 : 0;
    }
    EXPECT_EQ(times, 1) << name_of(scene);
  }
}

TEST(VariedCloud, TheSameSeedTheSameAndAnotherAnother) {
  std::set<decltype(facts(CloudSettings()))> all;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const CloudSettings cloud = varied_cloud(seed);
    EXPECT_EQ(facts(cloud), facts(varied_cloud(seed)));
    EXPECT_GE(cloud.points, 250'000U);
    EXPECT_LE(cloud.points, 1'000'000U);
    all.insert(facts(cloud));
  }
  EXPECT_EQ(all.size(), 200U);
  EXPECT_GT(std::get<0>(*all.rbegin()), 2 * std::get<0>(*all.begin()));
}

TEST(SweepWorld, TheSameSeedTheSameAndNothingLost) {
  const SweepWorld fast(scene_lidar(), 20, 4);
  const SweepWorld again(scene_lidar(), 20, 4);
  EXPECT_TRUE(std::ranges::equal(fast.sweep.points.z, again.sweep.points.z));
  EXPECT_EQ(fast.truth.visible[0].ids, again.truth.visible[0].ids);
  EXPECT_FALSE(fast.truth.visible[0].ids.empty());
  const SweepWorld slow(scene_lidar(), 5, 4);
  EXPECT_NEAR(static_cast<double>(slow.sweep.points.size()),
              4 * static_cast<double>(fast.sweep.points.size()), 500);
  for (const SweepWorld* world : {&fast, &slow}) {
    EXPECT_LT(world->sweep.points.size(), world->sweep.points.capacity());
  }
}

}  // namespace
}  // namespace scree
