#include "simulator/surface_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "simulator/ray_caster.hpp"

namespace scree {
namespace {

TerrainSettings small_terrain() {
  TerrainSettings settings;
  settings.size = 8;
  settings.placed_within = 3;
  settings.cell = 0.04;
  settings.positive = settings.negative = settings.smooth = settings.pairs = 0;
  return settings;
}

TerrainSettings level() {
  TerrainSettings settings = small_terrain();
  settings.gentlest_slope_deg = settings.steepest_slope_deg = 0;
  settings.roughness = 0;
  return settings;
}

double distance_to_nearest_vertex(const Terrain& terrain, const Eigen::Vector3d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < terrain.vertices(); ++v) {
    for (std::size_t u = 0; u < terrain.vertices(); ++u) {
      const Eigen::Vector3d vertex(terrain.coordinate(u), terrain.coordinate(v),
                                   static_cast<double>(terrain.vertex(u, v)));
      least = std::min(least, (vertex - point).norm());
    }
  }
  return least;
}

TEST(SurfaceDistance, OverLevelGroundItIsTheHeight) {
  const Terrain terrain(level(), 1);
  EXPECT_NEAR(distance_to_surface(terrain, {0.013, -1.2, 0.3}), 0.3, 1e-6);
  EXPECT_NEAR(distance_to_surface(terrain, {0.013, -1.2, -0.05}), 0.05, 1e-6);
  EXPECT_NEAR(distance_to_surface(terrain, {3.99, 3.99, 0.5}), 0.5, 1e-6) << "at the edge";
}

TEST(SurfaceDistance, APointOnAWallIsOnTheSurface) {
  TerrainSettings settings = small_terrain();
  settings.positive = 3;
  settings.weights = {};
  settings.weights[static_cast<std::size_t>(ShapeKind::block)] = 1;
  const Terrain terrain(settings, 3);
  const RayCaster caster(terrain);
  int on_walls = 0;
  for (const TerrainFeature& feature : terrain.features()) {
    for (double angle = 0; angle < 6.2; angle += 0.5) {
      const Eigen::Vector3d inwards(std::cos(angle), std::sin(angle), 0);
      const Eigen::Vector3d outside = feature.center - 1.2 * inwards;
      if (outside.z() < terrain.height(outside.x(), outside.y())) continue;
      const auto range = caster.cast(outside, inwards, 1.2);
      if (!range) continue;
      const Eigen::Vector3d hit = outside + *range * inwards;
      EXPECT_LT(distance_to_surface(terrain, hit), 0.006);
      const Eigen::Vector3d before = hit - 0.05 * inwards;
      const double above = before.z() - terrain.height(before.x(), before.y());
      const double distance = distance_to_surface(terrain, before);
      const double vertex = distance_to_nearest_vertex(terrain, before);
      EXPECT_LE(distance, std::min(above, 0.056));
      EXPECT_LE(distance, vertex + 1e-9);
      on_walls += above > 0.1 ? 1 : 0;
    }
  }
  EXPECT_GT(on_walls, 5);
}

TEST(SurfaceDistance, BelowARocksEdgeItIsToTheGroundOrTheRock) {
  TerrainSettings settings = level();
  settings.positive = 6;
  settings.undercut = 1;
  settings.weights = {};
  settings.weights[static_cast<std::size_t>(ShapeKind::block)] = 1;
  const Terrain terrain(settings, 3);
  int below = 0;
  for (double x = -3; x < 3; x += 0.05) {
    for (double y = -3; y < 3; y += 0.05) {
      const double air = terrain.underside(x, y);
      if (air < 0.12 || terrain.height(x, y) < air + 0.03) continue;
      ++below;
      EXPECT_NEAR(terrain.clearance({x, y, 0.02}), 0.02, 1e-6);
      EXPECT_LE(distance_to_surface(terrain, {x, y, 0.02}), 0.02 + 1e-6);
      EXPECT_LE(distance_to_surface(terrain, {x, y, air - 0.02}), 0.02 + 1e-6);
      EXPECT_GT(terrain.clearance({x, y, air / 2}), 0);
      EXPECT_LT(terrain.clearance({x, y, air + 0.02}), 0);
    }
  }
  EXPECT_GT(below, 20);
}

TEST(SurfaceDistance, OfACloudIsBroughtToTheWorldFirst) {
  const Terrain terrain(level(), 1);
  PointCloud cloud(3);
  cloud.push_back(1, 0, 0.4F, 0);
  cloud.push_back(0, 1, 0.6F, 0);
  cloud.push_back(100, 0, 0, 0);  // the terrain ends before
  const Pose to_world{{0.5, 0, -0.5}, from_roll_pitch_yaw(0, 0, 1)};
  const SurfaceError error = surface_error(terrain, cloud, to_world);
  EXPECT_EQ(error.points, 2U);
  EXPECT_EQ(error.near_volumes, 0U);
  EXPECT_NEAR(error.rms(), 0.1, 1e-6);
  EXPECT_TRUE(std::isnan(SurfaceError().rms()));
}

TEST(SurfaceDistance, GrassIsNoSurface) {
  TerrainSettings settings = level();
  settings.tuft_cover = 0.1;
  const Terrain terrain(settings, 1);
  ASSERT_FALSE(terrain.volumes().all().empty());
  const Volume& tuft = terrain.volumes().all().front();
  PointCloud cloud(1);
  cloud.push_back(static_cast<float>(tuft.center.x() + tuft.half.x()),
                  static_cast<float>(tuft.center.y()), 0.1F, 0);
  const SurfaceError error = surface_error(terrain, cloud, Pose());
  EXPECT_EQ(error.points, 0U);
  EXPECT_EQ(error.near_volumes, 1U);
}

}  // namespace
}  // namespace scree
