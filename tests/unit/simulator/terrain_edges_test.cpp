#include "simulator/terrain_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scoring/footprints.hpp"
#include "simulator/scene.hpp"
#include "simulator/terrain.hpp"
#include "simulator/visibility.hpp"
#include "unit/simulator/bare_terrain.hpp"

namespace scree {
namespace {

/// A winding way about the origin.
std::vector<Eigen::Vector2d> winding_way() {
  std::vector<Eigen::Vector2d> way;
  for (double x = -6; x < 6; x += 0.25) way.emplace_back(x, 2 * std::sin(x / 2));
  return way;
}

constexpr std::array kAllKinds = {
    TerrainEdgeKind::cliff, TerrainEdgeKind::kerb,   TerrainEdgeKind::bank, TerrainEdgeKind::stairs,
    TerrainEdgeKind::ditch, TerrainEdgeKind::furrow, TerrainEdgeKind::pit};

TEST(TerrainEdge, TheWayStaysOnItsNearSide) {
  constexpr double kOff = 1.3;
  const auto way = winding_way();
  Random random(5);
  for (const TerrainEdgeKind kind : kAllKinds) {
    for (int i = 0; i < 40; ++i) {
      const double towards = random.uniform(-3, 3);
      const TerrainEdge edge = TerrainEdge::draw(kind, way, kOff, towards, 60, random);
      double nearest = 100;
      for (const Eigen::Vector2d& by : way) {
        EXPECT_LT(edge.beyond(by), 0) << name_of(kind);
        for (const Eigen::Vector2d& point : edge.line()) {
          nearest = std::min(nearest, (point - by).norm());
        }
      }
      EXPECT_GT(nearest, 0.6 * kOff) << name_of(kind);
    }
  }
}

TEST(TerrainEdge, ItsStripIsAnOutlineThatDoesNotCrossItself) {
  const auto way = winding_way();
  Random random(6);
  for (const TerrainEdgeKind kind : kAllKinds) {
    for (int i = 0; i < 25; ++i) {
      const TerrainEdge edge = TerrainEdge::draw(kind, way, 1, random.uniform(-3, 3), 60, random);
      if (edge.line().size() < 4) continue;
      EXPECT_EQ(uncrossed(edge.footprint()), edge.footprint()) << name_of(kind) << ' ' << i;
      EXPECT_LE(distance(edge.footprint(), edge.middle()), 0.05) << name_of(kind);
      EXPECT_GE(least_width(edge.footprint()), 0.29) << name_of(kind);
    }
  }
}

TEST(TerrainEdge, TheGroundBeyondLiesAsMuchLowerOrHigherAsItSays) {
  const auto way = winding_way();
  Random random(7);
  for (const TerrainEdgeKind kind : {TerrainEdgeKind::cliff, TerrainEdgeKind::kerb,
                                     TerrainEdgeKind::bank, TerrainEdgeKind::stairs}) {
    const TerrainEdge edge = TerrainEdge::draw(kind, way, 1, 0.3, 60, random);
    EXPECT_EQ(edge.profile(-0.01), 0);
    EXPECT_NEAR(edge.profile(edge.width() + 0.5), edge.height(), 1e-9) << name_of(kind);
  }
  const TerrainEdge ditch = TerrainEdge::draw(TerrainEdgeKind::ditch, way, 1, 0.3, 60, random);
  EXPECT_NEAR(ditch.profile(ditch.width() / 2), ditch.height(), 1e-9);
  EXPECT_NEAR(ditch.profile(ditch.width()), 0, 1e-9);
}

TEST(TerrainEdge, LowStepsAndGentleBanksAreNoObstacles) {
  const auto way = winding_way();
  Random random(8);
  for (int i = 0; i < 60; ++i) {
    const TerrainEdge kerb = TerrainEdge::draw(TerrainEdgeKind::kerb, way, 1, 0.3, 60, random);
    EXPECT_EQ(kerb.is_minor(), std::abs(kerb.height()) < 0.15);
    EXPECT_FALSE(kerb.is_ground());
    const TerrainEdge bank = TerrainEdge::draw(TerrainEdgeKind::bank, way, 1, 0.3, 60, random);
    double steepest = 0;
    for (double d = 0; d < bank.width(); d += 0.01) {
      steepest = std::max(steepest, std::abs(bank.profile(d + 0.01) - bank.profile(d)) / 0.01);
    }
    EXPECT_LT(steepest, std::tan(36 * M_PI / 180));
    EXPECT_TRUE(bank.is_minor());
    EXPECT_EQ(bank.is_ground(), steepest < std::tan(30 * M_PI / 180));
  }
}

/// Level ground that ends in a cliff or pit 3 m from the robot's way.
Terrain terrain_with(const EdgeCounts& edges, std::uint64_t seed) {
  TerrainSettings settings = test::level_terrain();
  settings.size = 40;
  settings.cell = 0.05;
  settings.corridor = winding_way();
  settings.edges = edges;
  return {settings, seed};
}

TEST(TerrainEdges, AreTruthWithASign) {
  std::set<ObstacleKind> kinds;
  for (std::uint64_t seed = 1; seed < 9; ++seed) {
    const Terrain terrain = terrain_with({.cliffs = 1}, seed);
    ASSERT_EQ(terrain.features().size(), 1U);
    const TerrainFeature& cliff = terrain.features()[0];
    kinds.insert(*cliff.kind);
    EXPECT_EQ(cliff.kind == ObstacleKind::negative, cliff.height < 0);
    EXPECT_TRUE(contains(cliff.footprint, cliff.center.head<2>()));
    EXPECT_TRUE(cliff.is_long());
    const TerrainEdge& edge = terrain.edges()[0];
    for (std::size_t i = 0; i < edge.line().size(); ++i) {
      const Eigen::Vector2d& on = edge.line()[i];
      if (!terrain.covers(1.2 * on.x(), 1.2 * on.y())) continue;
      EXPECT_NEAR(edge.beyond(on), 0, 1e-6);
    }
  }
  EXPECT_EQ(kinds.size(), 2U);
}

TEST(TerrainEdges, RocksAndHolesKeepOffThem) {
  TerrainSettings settings = scene_terrain(Scene::cliff, 800, 3);
  settings.size = 40;
  settings.cell = 0.05;
  settings.corridor = winding_way();
  settings.placed_within = 10;
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const Terrain terrain(settings, seed);
    for (const TerrainFeature& a : terrain.features()) {
      for (const TerrainFeature& b : terrain.features()) {
        if (!a.is_edge || b.is_edge) continue;
        EXPECT_GT(distance(a.footprint, b.footprint), 0.2) << a.name << " and " << b.name;
      }
    }
  }
}

class EdgeSight : public testing::Test {
protected:
  EdgeSight() : terrain_(terrain_with({.cliffs = 1}, 3)), visibility_(terrain_) {}

  const TerrainFeature& cliff() const { return terrain_.features()[0]; }

  /// Shots on the parts of the edge that lie this close to its middle.
  void sweep(double within) {
    for (std::size_t i = cliff().first_part; i < cliff().first_part + cliff().parts; ++i) {
      const Eigen::Vector2d& place = terrain_.parts()[i].place;
      if ((place - cliff().center.head<2>()).norm() > within) continue;
      for (int shot = 0; shot < 10; ++shot) {
        SimulatedShot hit{.range = 5, .part = static_cast<std::uint16_t>(i)};
        visibility_.add(std::span(&hit, 1));
      }
    }
    visibility_.end_sweep();
  }

  bool asks(double distance, double yaw) const {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
    const Pose base{cliff().center - turn * Eigen::Vector3d(distance, 0, 0), turn};
    const auto ids = visibility_.asked_for(base).ids;
    return std::ranges::find(ids, cliff().id) != ids.end();
  }

  Terrain terrain_;
  Visibility visibility_;
};

TEST_F(EdgeSight, IsAskedForWhereTwoMetresOfItAreKnown) {
  EXPECT_FALSE(asks(3, 0));
  sweep(2);
  sweep(2);
  EXPECT_FALSE(asks(3, 0)) << "two sweeps";
  sweep(2);
  EXPECT_TRUE(asks(3, 0));
  EXPECT_TRUE(asks(3, 2));
  EXPECT_FALSE(asks(9, 0)) << "far";
  EXPECT_FALSE(asks(-6, 0)) << "behind";
}

TEST_F(EdgeSight, OneMetreIsNotEnough) {
  for (int i = 0; i < 9; ++i) sweep(0.5);
  EXPECT_FALSE(asks(3, 0));
}

}  // namespace
}  // namespace scree
