#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "simulator/lidar.hpp"
#include "simulator/scene.hpp"

namespace scree {
namespace {

/// Numbers that change when anything about a terrain, or about the order of what is drawn, does.
struct Mark {
  Scene scene;
  std::size_t features, tufts;
  double heights, relief, ranges;
};

Mark mark_of(Scene scene) {
  TerrainSettings settings = scene_terrain(scene, 400, 7);
  settings.size = 24;
  settings.placed_within = 10;
  settings.cell = 0.1;
  settings.clear_radius = 1.5;
  const Terrain terrain(settings, 7);
  Mark mark{scene, terrain.features().size(), terrain.volumes().all().size(), 0, 0, 0};
  for (std::size_t row = 0; row < terrain.vertices(); ++row) {
    for (std::size_t column = 0; column < terrain.vertices(); ++column) {
      const double weight = 1 + 0.01 * static_cast<double>(row + 2 * column);
      mark.heights += weight * static_cast<double>(terrain.vertex(column, row));
      mark.relief += weight * terrain.relief(terrain.coordinate(column), terrain.coordinate(row));
    }
  }
  const RayCaster caster(terrain);
  SimulatedLidar lidar(terrain, caster, {.dust_share = 0.01}, scene_lidar().mount(), 0, 7);
  for (int packet = 0; packet < 20; ++packet) {
    lidar.advance();
    for (const SimulatedShot& shot : lidar.shots()) mark.ranges += static_cast<double>(shot.range);
  }
  return mark;
}

TEST(KnownScenes, AreWhatTheyHaveAlwaysBeen) {
  constexpr std::array<Mark, 7> kMarks = {{
      {Scene::easy, 18, 0, -3857.6843, 1233.2576, 20744.5505},
      {Scene::rolling, 22, 72, -28970.1808, 774.6830, 16939.4462},
      {Scene::rough, 28, 134, -17466.9667, 2185.1552, 18364.9542},
      {Scene::crater, 22, 0, -13430.2832, 1202.4020, 18862.8909},
      {Scene::ditch, 18, 135, -7911.8076, 2438.9024, 18792.8112},
      {Scene::grass, 19, 1535, -7333.7696, 3017.1424, 19560.7005},
      {Scene::mixed, 23, 371, -13909.5079, 1026.0817, 19108.1167},
  }};
  for (const Mark& known : kMarks) {
    const Mark mark = mark_of(known.scene);
    EXPECT_EQ(mark.features, known.features) << name_of(known.scene);
    EXPECT_EQ(mark.tufts, known.tufts) << name_of(known.scene);
    EXPECT_NEAR(mark.heights, known.heights, 1e-3) << name_of(known.scene);
    EXPECT_NEAR(mark.relief, known.relief, 1e-3) << name_of(known.scene);
    EXPECT_NEAR(mark.ranges, known.ranges, 1e-3) << name_of(known.scene);
  }
}

}  // namespace
}  // namespace scree
