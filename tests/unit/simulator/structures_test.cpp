#include "simulator/structures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scoring/footprints.hpp"
#include "simulator/beam.hpp"
#include "simulator/cloud.hpp"
#include "simulator/visibility.hpp"
#include "unit/simulator/bare_terrain.hpp"

namespace scree {
namespace {

TerrainSettings street(std::uint64_t seed) {
  TerrainSettings settings = test::level_terrain();
  settings.size = 40;
  settings.cell = 0.1;
  settings.placed_within = 10;
  const double angle = static_cast<double>(seed);
  for (double x = -5; x < 5; x += 0.25) {
    settings.corridor.emplace_back(x * std::cos(angle), x * std::sin(angle));
  }
  return settings;
}

Terrain built(const StructureCounts& structures, std::uint64_t seed) {
  TerrainSettings settings = street(seed);
  settings.structures = structures;
  return {settings, seed};
}

const TerrainFeature* named(const Terrain& terrain, std::string_view name) {
  const auto found = std::ranges::find(terrain.features(), name, &TerrainFeature::name);
  return found == terrain.features().end() ? nullptr : &*found;
}

TEST(Structures, StandApartAndLeaveTheWayFree) {
  std::map<std::string_view, int> count;
  for (std::uint64_t seed = 1; seed < 8; ++seed) {
    const Terrain terrain =
        built({.facades = 2, .fences = 3, .cars = 3, .poles = 3, .booms = 3, .debris = 8}, seed);
    for (const TerrainFeature& each : terrain.features()) {
      ++count[each.name];
      EXPECT_EQ(each.kind, ObstacleKind::positive);
      EXPECT_EQ(uncrossed(each.footprint), each.footprint) << each.name;
      EXPECT_TRUE(contains(each.footprint, each.center.head<2>())) << each.name;
      for (const Eigen::Vector2d& by : terrain.settings().corridor) {
        EXPECT_GE(distance(each.footprint, by), terrain.settings().corridor_half_width);
      }
      for (const TerrainFeature& other : terrain.features()) {
        if (other.id == each.id) continue;
        EXPECT_GT(distance(other.footprint, each.footprint), 0.3);
      }
    }
  }
  for (const char* name :
       {"facade", "wall", "fence", "car", "pole", "boom", "table", "box", "plank"}) {
    EXPECT_GE(count[name], 1) << name;
  }
}

TEST(Structures, HitsOnThemLieInTheirFootprints) {
  const Terrain terrain =
      built({.facades = 1, .fences = 2, .cars = 2, .poles = 2, .booms = 2, .debris = 4}, 3);
  const RayCaster caster(terrain);
  Random random(1);
  std::map<int, int> hits;
  for (int i = 0; i < 200'000; ++i) {
    const double azimuth = random.uniform(0, 2 * M_PI);
    const double up = random.uniform(-0.3, 0.15);
    const Eigen::Vector3d way(std::cos(azimuth) * std::cos(up), std::sin(azimuth) * std::cos(up),
                              std::sin(up));
    const Eigen::Vector3d origin(0, 0, 1);
    const auto ground = caster.cast(origin, way, 40);
    const auto hit = terrain.volumes().cast(origin, way, ground.value_or(40), random);
    if (!hit || hit->volume->part == 0) continue;
    const TerrainFeature& feature =
        terrain
            .features()[static_cast<std::size_t>(terrain.parts()[hit->volume->part].feature) - 1];
    ++hits[feature.id];
    const Eigen::Vector3d at = origin + hit->range * way;
    EXPECT_LE(distance(feature.footprint, at.head<2>()), 0.1) << feature.name;
  }
  EXPECT_GE(hits.size(), 6U);
}

TEST(Structures, WindowsReturnNothing) {
  for (std::uint64_t seed = 1; seed < 8; ++seed) {
    const Terrain terrain = built({.facades = 1}, seed);
    if (named(terrain, "facade") == nullptr) continue;
    const RayCaster caster(terrain);
    Beam beam(terrain, caster, 80);
    Random random(1);
    for (const Volume& window : terrain.volumes().all()) {
      if (!window.is_dark) continue;
      const Eigen::Vector3d out = -window.axes.col(1);
      const Eigen::Vector3d origin = window.center + 2 * out;
      EXPECT_TRUE(
          beam.cast(origin, -out, window.axes.col(0), Eigen::Vector3d::UnitZ(), random).empty());
      const Eigen::Vector3d above = origin + Eigen::Vector3d(0, 0, window.half.z() + 0.05);
      EXPECT_FALSE(
          beam.cast(above, -out, window.axes.col(0), Eigen::Vector3d::UnitZ(), random).empty());
      return;
    }
  }
  FAIL() << "no window";
}

TEST(Structures, AWallIsSeenByTheMetre) {
  const Terrain terrain = built({.facades = 1}, 2);
  ASSERT_EQ(terrain.features().size(), 1U);
  const TerrainFeature& wall = terrain.features()[0];
  EXPECT_TRUE(wall.is_long());
  EXPECT_FALSE(wall.is_edge);
  Visibility visibility(terrain);
  const std::size_t middle = wall.first_part + wall.parts / 2;
  for (int sweep = 0; sweep < 3; ++sweep) {
    for (std::size_t part = middle; part < middle + 2; ++part) {
      for (int i = 0; i < 10; ++i) {
        SimulatedShot shot{.range = 5, .part = static_cast<std::uint16_t>(part), .relief = 1};
        visibility.add(std::span(&shot, 1));
      }
    }
    visibility.end_sweep();
  }
  const Eigen::Vector2d& seen = terrain.parts()[middle].place;
  const Pose base{{seen.x() - 7, seen.y(), 0}, Eigen::Quaterniond::Identity()};
  EXPECT_EQ(visibility.asked_for(base).ids.size(), 1U);
}

TEST(Structures, GroundIsSeenBelowABoom) {
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const Terrain terrain = built({.booms = 2}, seed);
    for (const TerrainFeature& boom : terrain.features()) {
      EXPECT_GT(boom.height, 0.3);
      EXPECT_LT(boom.height, 1.6);
      Random random(1);
      const Eigen::Vector3d middle(boom.center.x(), boom.center.y(), 0.1);
      const Eigen::Vector2d corner = boom.footprint[0] - boom.footprint[3];
      const Eigen::Vector3d across = Eigen::Vector3d(corner.x(), corner.y(), 0).normalized();
      EXPECT_FALSE(terrain.volumes().cast(middle - 0.5 * across, across, 1, random));
      EXPECT_TRUE(terrain.volumes().cast(middle + Eigen::Vector3d(0, 0, 3), {0, 0, -1}, 3, random));
    }
  }
}

TEST(Diggings, ARimmedCraterIsOneHoleInsideItsCrest) {
  for (std::uint64_t seed = 1; seed < 5; ++seed) {
    TerrainSettings settings = street(seed);
    settings.cell = 0.04;
    settings.diggings.rimmed_craters = 3;
    const Terrain terrain(settings, seed);
    ASSERT_GE(terrain.features().size(), 1U);
    for (const TerrainFeature& crater : terrain.features()) {
      EXPECT_EQ(crater.kind, ObstacleKind::negative);
      const Eigen::Vector2d middle = crater.center.head<2>();
      EXPECT_NEAR(terrain.relief(middle.x(), middle.y()), crater.height, 0.03);
      for (const Eigen::Vector2d& corner : crater.footprint) {
        EXPECT_GT(terrain.relief(corner.x(), corner.y()), 0.05) << "the crest";
        const Eigen::Vector2d out = middle + 2.2 * (corner - middle);
        if (terrain.covers(out.x(), out.y()) && terrain.feature_at(out.x(), out.y()) == 0) {
          EXPECT_LT(terrain.relief(out.x(), out.y()), 0.4);
        }
      }
    }
  }
}

TEST(Diggings, StillWaterReturnsNothingAndIsNotAskedFor) {
  TerrainSettings settings = street(2);
  settings.diggings.ponds = 1;
  const Terrain terrain(settings, 2);
  ASSERT_EQ(terrain.features().size(), 1U);
  const TerrainFeature& pond = terrain.features()[0];
  EXPECT_TRUE(pond.is_small);
  const RayCaster caster(terrain);
  Beam beam(terrain, caster, 80);
  Random random(1);
  const Eigen::Vector3d above = pond.center + Eigen::Vector3d(0, 0, 2);
  EXPECT_TRUE(beam.cast(above, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, random).empty());
  const Eigen::Vector3d beside(above.x() + 8, above.y(), above.z());
  if (terrain.covers(beside.x(), beside.y())) {
    EXPECT_FALSE(beam.cast(beside, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, random).empty());
  }
  CloudSettings cloud;
  cloud.points = 20'000;
  cloud.scattered_share = 0;
  const PointCloud points = reconstructed_cloud(terrain, cloud, 2);
  int in_pond = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d at(static_cast<double>(points.x[i]), static_cast<double>(points.y[i]));
    in_pond += (at - pond.center.head<2>()).norm() < 0.5 ? 1 : 0;
  }
  EXPECT_EQ(in_pond, 0);
}

TEST(Diggings, RutsMayCrossTheWayAndAreNotAskedFor) {
  TerrainSettings settings = street(4);
  settings.edges.ruts = 2;
  const Terrain terrain(settings, 4);
  EXPECT_EQ(terrain.features().size(), 4U);
  for (const TerrainFeature& rut : terrain.features()) {
    EXPECT_TRUE(rut.is_small);
    EXPECT_GT(rut.height, -0.15);
  }
}

}  // namespace
}  // namespace scree
