#include "simulator/ray_caster.hpp"

#include <gtest/gtest.h>

#include "scree/core/pose.hpp"
#include "simulator/bare_terrain.hpp"

namespace scree {
namespace {

const Eigen::Vector3d kLevel(1, 1, 0), kUp = Eigen::Vector3d::UnitZ();

Eigen::Vector3d direction(double azimuth_deg, double elevation_deg) {
  const double a = radians(azimuth_deg);
  const double e = radians(elevation_deg);
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

TEST(RayCaster, MeetsALevelPlaneWhereItShould) {
  const Terrain terrain(test::level_terrain(), 1);
  const RayCaster caster(terrain);
  const Eigen::Vector3d origin(0.1, -0.2, 0.95);
  for (double azimuth = 0; azimuth < 360; azimuth += 7.3) {
    for (double elevation = -89.9; elevation < -5.5; elevation += 4.1) {
      const auto range = caster.cast(origin, direction(azimuth, elevation), 30);
      ASSERT_TRUE(range) << azimuth << ' ' << elevation;
      EXPECT_NEAR(*range, 0.95 / std::sin(radians(-elevation)), 1e-4);
    }
    EXPECT_FALSE(caster.cast(origin, direction(azimuth, 0), 30));
    EXPECT_FALSE(caster.cast(origin, direction(azimuth, 12), 30));
    EXPECT_FALSE(caster.cast(origin, direction(azimuth, -4), 5));  // the beam ends in the air
  }
}

TEST(RayCaster, AgreesWithFineStepsOverRoughGround) {
  TerrainSettings settings;
  settings.size = 24;
  settings.placed_within = 12;
  settings.clear_radius = 1;
  const Terrain terrain(settings, 3);
  const RayCaster caster(terrain);
  const Eigen::Vector3d origin(0, 0, 0.95);
  int hits = 0;
  for (double azimuth = 0; azimuth < 360; azimuth += 3.1) {
    for (double elevation = -20; elevation < 6; elevation += 1.3) {
      const Eigen::Vector3d beam = direction(azimuth, elevation);
      std::optional<double> expected;
      for (double t = 0; t < 30; t += 0.001) {
        const Eigen::Vector3d at = origin + t * beam;
        if (!terrain.covers(at.x(), at.y())) break;
        if (at.z() > terrain.height(at.x(), at.y())) continue;
        expected = t;
        break;
      }
      const auto range = caster.cast(origin, beam, 30);
      // A beam may just touch a crest that one of the two steps over.
      if (expected.has_value() != range.has_value()) continue;
      if (!range) continue;
      hits += std::abs(*range - *expected) < 0.003 ? 1 : -20;
    }
  }
  EXPECT_GT(hits, 1000);
}

TEST(RayCaster, LooksBelowTheEdgeOfARockThatLiesOnTheGround) {
  TerrainSettings settings = test::level_terrain();
  settings.positive = 12;
  settings.pairs = 0;
  settings.weights = {};
  settings.weights[static_cast<std::size_t>(ShapeKind::boulder)] = 1;
  settings.undercut = 1;
  settings.placed_within = 8;
  const Terrain terrain(settings, 3);
  const RayCaster caster(terrain);
  constexpr double kAway = 2;
  int deeper = 0, below = 0;
  for (const TerrainFeature& rock : terrain.features()) {
    for (double azimuth = 0; azimuth < 360; azimuth += 20) {
      const Eigen::Vector3d inwards = direction(azimuth, 0);
      const auto range_at = [&](double height) {
        const Eigen::Vector3d from = (rock.center - kAway * inwards).cwiseProduct(kLevel);
        return caster.cast(from + height * kUp, inwards, kAway + 2).value_or(kAway + 2);
      };
      const double at_the_ground = range_at(0.004);
      double nearest = at_the_ground;
      for (double height = 0.01; height < rock.height; height += 0.01) {
        nearest = std::min(nearest, range_at(height));
      }
      if (at_the_ground < nearest + 0.02) continue;
      ++deeper;
      // A beam that comes down to just before the rock's foot meets the ground below its edge.
      const Eigen::Vector3d foot =
          rock.center.cwiseProduct(kLevel) + (at_the_ground - 0.01 - kAway) * inwards;
      const Eigen::Vector3d from = foot - kAway * inwards + 0.05 * kUp;
      const auto range = caster.cast(from, (foot - from).normalized(), kAway + 1);
      ASSERT_TRUE(range);
      below += std::abs(*range - (foot - from).norm()) < 1e-2 &&
                       terrain.feature_at(foot.x(), foot.y()) == rock.id
                   ? 1
                   : 0;
    }
  }
  EXPECT_GT(deeper, 100);
  EXPECT_GT(below, deeper / 2);
}

}  // namespace
}  // namespace scree
