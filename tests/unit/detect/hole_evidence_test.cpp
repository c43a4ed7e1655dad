#include "scree/detect/hole_evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <vector>

#include "detect/clouds.hpp"

namespace scree {
namespace {

constexpr std::size_t kHolePoints = 60'000, kHoleCells = 1 << 15;
const Eigen::Vector3f kBesideThePit(-3, 0, 1);

/// Where something is seen, NaN: nothing is.
using Height = std::function<float(float, float)>;

/// 8 x 8 m of ground, and what lies below it.
struct World {
  PointCloud cloud{kHolePoints};
  CandidatePoints below{kHolePoints};
  GroundSurface surface{test::kGroundSettings, kHolePoints, kHoleCells};
  HoleEvidence evidence{kHoleCells};

  explicit World(const Height& height, std::size_t points = 30'000) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-4, 4);
    std::normal_distribution<float> noise(0, 0.005F);
    for (std::size_t i = 0; i < points; ++i) {
      const float x = place(random), y = place(random), z = height(x, y);
      if (std::isnan(z)) continue;
      cloud.push_back(x, y, z + noise(random), 0);
    }
    surface.build(cloud);
  }

  /// Of the points more than 0.1 m below the surface.
  Evidence of(bool knows_beams) {
    below.clear();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const float depth = cloud.z[i] - surface.height(cloud.x[i], cloud.y[i]);
      if (depth < -0.1F) below.push_back(cloud, i, 0, 0, depth);
    }
    SeenCloud seen{.points = cloud};
    if (knows_beams) seen.origins = {&kBesideThePit, 1};
    evidence.build(seen, surface);
    std::vector<std::uint32_t> members(below.size());
    std::iota(members.begin(), members.end(), 0U);
    EXPECT_FALSE(members.empty());
    return evidence.of(members, below, surface);
  }
};

TEST(HoleEvidence, OfAPitWhoseFloorIsSeenIsItsInside) {
  World world([](float x, float y) { return test::in_square(x, y, 0.5F) ? -0.3F : 0.0F; });
  EXPECT_EQ(world.of(true), Evidence::inside);
  EXPECT_EQ(world.of(false), Evidence::inside);
}

TEST(HoleEvidence, OfAPitWhoseFloorHasGapsIsItsInside) {
  World world([](float x, float y) {
    if (!test::in_square(x, y, 0.8F)) return 0.0F;
    const auto tile = [](float place) { return static_cast<int>((place + 4) / 0.15F); };
    const bool is_gap = (tile(x) + tile(y)) % 2 == 0;
    return is_gap ? std::nanf("") : -0.3F;
  });
  EXPECT_EQ(world.of(false), Evidence::inside);
}

TEST(HoleEvidence, OfAPitWhoseFarWallAloneIsSeenIsTheWall) {
  World world([](float x, float y) {
    if (!test::in_square(x, y, 0.8F)) return 0.0F;
    // The wall leans, so that it has points seen from above.
    return x > 0.6F ? -0.3F * (0.8F - x) / 0.2F - 0.1F : std::nanf("");
  });
  EXPECT_EQ(world.of(true), Evidence::wall);
}

TEST(HoleEvidence, IsNoneWhereBeamsWouldHavePassedThroughGround) {
  // The points lie 1.5 m below ground that ends just above them: no beam from the sensor gets
  // there.
  World world([](float x, float y) { return test::in_square(x, y, 0.3F) ? -1.5F : 0.0F; });
  EXPECT_EQ(world.of(true), Evidence::none);
  EXPECT_EQ(world.of(false), Evidence::inside) << "where nothing is known of beams it may be a pit";
}

TEST(HoleEvidence, IsNoneWhereTheRimIsHardlyKnown) {
  World world([](float x, float y) {
    if (test::in_square(x, y, 0.5F)) return -0.3F;
    const bool is_known = x < -1.2F || (x < 0 && std::abs(y) < 0.3F);
    return is_known ? 0.0F : std::nanf("");
  });
  EXPECT_EQ(world.of(true), Evidence::none);
  EXPECT_EQ(world.of(false), Evidence::none);
}

TEST(HoleEvidence, KnowsWhereBeamsWentBelowTheGround) {
  World world([](float x, float y) { return test::in_square(x, y, 0.5F) ? -0.3F : 0.0F; });
  world.of(true);
  EXPECT_TRUE(world.evidence.is_void(world.surface.cell_at(0, 0)));
  EXPECT_FALSE(world.evidence.is_void(world.surface.cell_at(2, 2)));
  world.of(false);
  EXPECT_FALSE(world.evidence.is_void(world.surface.cell_at(0, 0))) << "nothing is known of beams";
}

TEST(HoleEvidence, CountsBeamsThatDidNotComeBackWhereGroundWasDue) {
  World world([](float x, float) { return x < 0 ? 0.0F : std::nanf(""); });
  const Eigen::Vector3f sensor(-1, 0, 1);
  const std::vector<PassingBeam> lost(5, {sensor, Eigen::Vector3f(1, 0, -1).normalized(), 1000});
  world.evidence.build({.points = world.cloud, .origins = {&sensor, 1}, .passing = lost},
                       world.surface);
  const std::size_t before = world.surface.cell_at(-0.5F, 0);
  const std::size_t beyond = world.surface.cell_at(0.06F, 0);
  EXPECT_EQ(world.evidence.lost_beams(before), 0) << "there they were above the ground";
  EXPECT_EQ(world.evidence.lost_beams(beyond), 5);
  EXPECT_NEAR(world.evidence.lowest_beam(beyond), -0.06, 0.06);
  // Where the cloud ends, nothing tells that ground was seen.
  SeenCloud seen{.points = world.cloud, .origins = {&sensor, 1}, .passing = lost};
  seen.robot = sensor.head<2>();
  for (const float reach : {1.0F, 1.2F}) {
    seen.reach = reach;
    world.evidence.build(seen, world.surface);
    EXPECT_EQ(world.evidence.lost_beams(beyond), reach > 1.1F ? 5 : 0) << reach;
  }
}

}  // namespace
}  // namespace scree
