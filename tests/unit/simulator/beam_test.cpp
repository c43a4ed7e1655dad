#include "simulator/beam.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "scree/core/pose.hpp"
#include "simulator/bare_terrain.hpp"

namespace scree {
namespace {

struct Axes {
  Eigen::Vector3d along, left, up;
};

Axes axes(double azimuth, double elevation) {
  const Eigen::Matrix3d turned = from_roll_pitch_yaw(0, -elevation, azimuth).toRotationMatrix();
  return {turned.col(0), turned.col(1), turned.col(2)};
}

TEST(Beam, LevelGroundGivesOneEchoAndTheSkyNone) {
  const Terrain terrain(test::level_terrain(), 1);
  const RayCaster caster(terrain);
  Beam beam(terrain, caster, 80);
  Random random(1);
  const auto [along, left, up] = axes(0.3, -0.2);
  const auto& echoes = beam.cast({0, 0, 1}, along, left, up, random);
  ASSERT_EQ(echoes.size(), 1U);
  EXPECT_NEAR(echoes[0].range, 1 / std::sin(0.2), 0.002);
  EXPECT_EQ(echoes[0].part, 0);
  EXPECT_GT(echoes[0].light, 10);
  const Axes skywards = axes(0.3, 0.2);
  EXPECT_TRUE(beam.cast({0, 0, 1}, skywards.along, skywards.left, skywards.up, random).empty());
}

TEST(Beam, FarGrazingLightIsFaint) {
  TerrainSettings settings = test::level_terrain();
  settings.size = 100;
  settings.cell = 0.1;
  const Terrain terrain(settings, 1);
  const RayCaster caster(terrain);
  Beam beam(terrain, caster, 80);
  Random random(1);
  const auto [along, left, up] = axes(0, -0.025);
  const auto& echoes = beam.cast({0, 0, 1}, along, left, up, random);
  ASSERT_EQ(echoes.size(), 1U);
  EXPECT_LT(echoes[0].light, 3);
}

TEST(Beam, EdgesMixNearSurfacesAndPartFarOnes) {
  TerrainSettings settings = test::level_terrain();
  settings.positive = 6;
  settings.pairs = 0;
  settings.placed_within = 8;
  settings.clear_radius = 1;
  const Terrain terrain(settings, 4);
  const RayCaster caster(terrain);
  Beam beam(terrain, caster, 80);
  Random random(1);
  const Eigen::Vector3d origin(0, 0, 0.95);
  int parted = 0;
  int mixed = 0;
  for (double azimuth = 0; azimuth < 4 * std::numbers::pi; azimuth += 0.001) {
    const auto [along, left, up] = axes(azimuth, azimuth < 2 * std::numbers::pi ? -0.12 : -0.18);
    const auto& echoes = beam.cast(origin, along, left, up, random);
    for (std::size_t i = 1; i < echoes.size(); ++i) {
      EXPECT_GE(echoes[i].range - echoes[i - 1].range, 0.3);
    }
    parted += echoes.size() > 1 ? 1 : 0;
    const auto line = caster.cast(origin, along, 80);
    if (line && echoes.size() == 1 && std::abs(echoes[0].range - *line) > 0.05) ++mixed;
  }
  EXPECT_GT(parted, 5);
  EXPECT_LT(parted, 200);
  EXPECT_GT(mixed, 3);
  EXPECT_LT(mixed, 200);
}

TEST(Beam, TuftsLetAPartOfTheLightThrough) {
  TerrainSettings settings = test::level_terrain();
  settings.tuft_cover = 0.3;
  const Terrain terrain(settings, 1);
  const RayCaster caster(terrain);
  Beam beam(terrain, caster, 80);
  Random random(1);
  int from_blades = 0;
  int from_ground = 0;
  for (double azimuth = 0; azimuth < 6.28; azimuth += 0.01) {
    const auto [along, left, up] = axes(azimuth, -0.3);
    const auto& echoes = beam.cast({0, 0, 1}, along, left, up, random);
    ASSERT_FALSE(echoes.empty());
    const double height = 1 - echoes[echoes.size() - 1].range * std::sin(0.3);
    (height > 0.02 ? from_blades : from_ground)++;
  }
  EXPECT_GT(from_blades, 50);
  EXPECT_GT(from_ground, 200);
}

}  // namespace
}  // namespace scree
