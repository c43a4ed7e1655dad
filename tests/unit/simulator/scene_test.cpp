#include "simulator/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

TEST(Scene, NamesAreReadBack) {
  for (const Scene scene : kScenes) EXPECT_EQ(scene_named(name_of(scene)), scene);
  EXPECT_FALSE(scene_named("swamp"));
}

TEST(Scene, EachHasRocksAndHolesAndGroundOfItsOwn) {
  for (const Scene scene : kScenes) {
    TerrainSettings settings = scene_terrain(scene, 400, 7);
    settings.size = 24;
    settings.placed_within = 12;
    settings.cell = 0.04;
    const Terrain terrain(settings, 7);
    int rocks = 0;
    int holes = 0;
    for (const TerrainFeature& feature : terrain.features()) {
      if (!feature.kind || feature.is_small) continue;
      (*feature.kind == ObstacleKind::positive ? rocks : holes)++;
      if (feature.partner == 0) continue;
      EXPECT_EQ(terrain.features()[static_cast<std::size_t>(feature.partner) - 1].partner,
                feature.id);
    }
    EXPECT_GE(rocks, 2) << name_of(scene);
    EXPECT_GE(holes, 1) << name_of(scene);
    EXPECT_EQ(obstacle_ids(terrain).size(), static_cast<std::size_t>(rocks + holes));
    const bool has_plants = settings.plants.trees + settings.plants.tall_grass > 0;
    EXPECT_EQ(scene == Scene::grass || has_plants, terrain.volumes().all().size() > 600)
        << name_of(scene);
  }
}

TEST(Scene, TuftsStandOnTheGroundBesideObstacles) {
  TerrainSettings settings = scene_terrain(Scene::grass, 400, 7);
  settings.size = 24;
  settings.placed_within = 12;
  settings.cell = 0.04;
  settings.tuft_cover = 0.3;
  const Terrain terrain(settings, 7);
  for (const Volume& tuft : terrain.volumes().all()) {
    EXPECT_NEAR(tuft.center.z(), terrain.height(tuft.center.x(), tuft.center.y()), 1e-6);
    const int id = terrain.feature_at(tuft.center.x(), tuft.center.y());
    EXPECT_TRUE(id == 0 || !terrain.features()[static_cast<std::size_t>(id) - 1].kind);
  }
  int covered = 0;
  Random random(1);
  constexpr int kPlaces = 4000;
  for (int i = 0; i < kPlaces; ++i) {
    covered += terrain.volumes().at(random.uniform(-11, 11), random.uniform(-11, 11)) != nullptr;
  }
  EXPECT_NEAR(static_cast<double>(covered) / kPlaces, 0.26, 0.08);
}

TEST(Scene, LightPassesThroughTheMiddleOfEachTuft) {
  const auto least_light = [](TerrainSettings settings) {
    settings.size = 24;
    settings.cell = 0.1;
    settings.placed_within = 12;
    settings.tuft_cover = 0.3;
    double least = 1;
    for (std::uint64_t seed = 1; seed < 6; ++seed) {
      const Terrain terrain(settings, seed);
      for (const Volume& tuft : terrain.volumes().all()) {
        least = std::min(least, std::exp(-tuft.density * 2 * tuft.half.x()));
      }
    }
    return least;
  };
  EXPECT_NEAR(least_light(scene_terrain(Scene::grass, 400, 7)), 0.15, 1e-9);
  EXPECT_LT(least_light(cloud_terrain(Scene::grass, 7)), 0.05);
}

}  // namespace
}  // namespace scree
