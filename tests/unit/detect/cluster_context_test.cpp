#include "scree/detect/cluster_context.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "scree/detect/detector.hpp"

namespace scree {
namespace {

/// Flat ground of 6 x 6 m; `shape` says what else stands at a place, given chance.
template <class Shape>
PointCloud ground_with(Shape&& shape) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-3, 3), chance(0, 1);
  PointCloud cloud(40'000);
  while (cloud.size() < cloud.capacity()) {
    const float x = place(random), y = place(random);
    const float z = shape(x, y, chance(random));
    if (!std::isnan(z)) cloud.push_back(x, y, z, 0);
  }
  return cloud;
}

/// Features of the largest cluster.
/// @param beams of each point
Features features_of(PointView cloud, std::span<const BeamCount> beams = {}) {
  DetectSettings settings = DetectSettings::for_cloud();
  settings.surface.clustering = SurfaceClustering::euclidean;  // else grass and rock come apart
  Detector detector(
      settings, {.points = 40'000, .candidates = 40'000, .ground_cells = 1 << 14, .obstacles = 16},
      Network());
  FixedVector<Obstacle> unused(16);
  StageTimer timer;
  detector.detect({.points = cloud, .beams = beams}, unused, timer);
  const auto clusters = detector.clustered().clusters.all();
  EXPECT_FALSE(clusters.empty());
  if (clusters.empty()) return {};
  return std::ranges::max_element(
             clusters, {}, [](const Cluster& cluster) { return cluster.end - cluster.begin; })
      ->features;
}

bool inside(float x, float y) {
  return std::abs(x) < 0.5F && std::abs(y) < 0.3F;
}

TEST(ClusterContext, LightPassesThroughATuftAndNotThroughARock) {
  const Features rock =
      features_of(ground_with([](float x, float y, float) { return inside(x, y) ? 0.4F : 0.0F; }));
  const Features tuft = features_of(ground_with([](float x, float y, float chance) {
    return inside(x, y) && chance < 0.6F ? 0.08F + 0.5F * chance : 0.0F;
  }));
  EXPECT_LT(rock[through_share], 0.1);
  EXPECT_GT(tuft[through_share], 0.5);
  EXPECT_LT(rock[cell_spread], 0.01) << "a level top";
  EXPECT_GT(tuft[cell_spread], 0.1) << "blades of 0.08 to 0.38 m in one cell";
  EXPECT_GT(tuft[cell_points], 1.3 * rock[cell_points]);
}

TEST(ClusterContext, MeasuresTheShareOfTheBeamsThatEnded) {
  const PointCloud cloud = ground_with([](float x, float y, float) {
    if (!inside(x, y)) return 0.0F;
    return x < 0 ? 0.5F : 0.2F;
  });
  const Features unknown = features_of(cloud);
  EXPECT_EQ(unknown[solid_share], 1);
  EXPECT_EQ(unknown[top_solidity], 1);
  EXPECT_EQ(unknown[core_solidity], 1);
  EXPECT_EQ(unknown[beam_count], 0);
  EXPECT_EQ(unknown[range_scatter], 0);

  // Grass around a rock: the higher half is solid.
  std::vector<BeamCount> beams;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    beams.push_back(cloud.x[i] < 0 ? BeamCount{100, 0, 1} : BeamCount{100, 300, 5});
  }
  const Features half = features_of(cloud, beams);
  EXPECT_NEAR(half[solid_share], 0.5, 0.1);
  EXPECT_GT(half[top_solidity], 0.95);
  EXPECT_GT(half[core_solidity], 0.95);
  const auto above = std::ranges::count_if(cloud.z, [](float z) { return z > 0; });
  EXPECT_NEAR(half[beam_count] / (100 * static_cast<float>(above)), 1, 0.05);
  EXPECT_NEAR(half[least_scatter], 0.01, 0.002);
  EXPECT_NEAR(half[firm_cells], 0.5, 0.1);
  EXPECT_NEAR(half[firm_beams], 0.5, 0.1);
  EXPECT_NEAR(half[solid_beams], 0.5, 0.1);
  EXPECT_GT(half[solid_core], 100);

  for (BeamCount& count : beams) count = {100, 300, 5};
  const Features grass = features_of(cloud, beams);
  EXPECT_EQ(grass[solid_share], 0);
  EXPECT_NEAR(grass[top_solidity], 0.25, 0.01);
  EXPECT_NEAR(grass[core_solidity], 0.25, 0.01);
  EXPECT_NEAR(grass[range_scatter], 0.05, 1e-4);
  EXPECT_NEAR(grass[least_scatter], 0.05, 1e-4);
  for (const Feature firm : {firm_cells, firm_beams, solid_beams, solid_core}) {
    EXPECT_EQ(grass[firm], 0) << firm;
  }
}

TEST(ClusterContext, CountsTheBeamsInAHoleAndTheGrassBesideIt) {
  const PointCloud cloud =
      ground_with([](float x, float y, float) { return inside(x, y) ? -0.4F : 0.0F; });
  std::vector<BeamCount> beams;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    beams.push_back(cloud.z[i] < 0 ? BeamCount{100, 0, 1} : BeamCount{100, 300, 5});
  }
  const Features hole = features_of(cloud, beams);
  ASSERT_NEAR(hole[min_height], -0.4, 0.01);
  EXPECT_EQ(hole[beam_count], 0) << "nothing stands there";
  const auto below = std::ranges::count_if(cloud.z, [](float z) { return z < 0; });
  EXPECT_NEAR(hole[all_beams] / (100 * static_cast<float>(below)), 1, 0.1) << "and of its rim";
  EXPECT_NEAR(hole[all_scatter], 0.01, 0.004);
  EXPECT_NEAR(hole[ground_scatter], 0.05, 0.002);
}

TEST(ClusterContext, KnowsTheGrassAround) {
  // A rock 0.4 m high between two strips of grass, 0.2 m high.
  const auto is_grass = [](float x, float y) {
    return std::abs(x) > 0.72F && std::abs(x) < 0.95F && std::abs(y) < 0.3F;
  };
  const PointCloud cloud = ground_with([&](float x, float y, float) {
    if (inside(x, y)) return 0.4F;
    return is_grass(x, y) ? 0.2F : 0.0F;
  });
  std::vector<BeamCount> beams(cloud.size(), {100, 0, 1});
  const Features among_rocks = features_of(cloud, beams);
  EXPECT_EQ(among_rocks[loose_around], 0);
  EXPECT_NEAR(among_rocks[over_loose], 0.4, 0.01);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (is_grass(cloud.x[i], cloud.y[i])) beams[i] = {100, 0, 6};
  }
  const Features in_grass = features_of(cloud, beams);
  EXPECT_GT(in_grass[loose_around], 0.03);
  EXPECT_LT(in_grass[loose_around], 0.12);
  EXPECT_NEAR(in_grass[over_loose], 0.2, 0.01);
  EXPECT_EQ(features_of(cloud)[loose_around], 0) << "nothing is known without beams";
}

TEST(ClusterContext, GroundBelowItsEdgeMakesARockNoLessSteep) {
  // As wide as a table on its foot: half the points within its outline lie on the ground.
  const auto table = [](float x, float y, float chance) {
    return inside(x, y) && chance < 0.5F ? 0.4F : 0.0F;
  };
  const PointCloud cloud = ground_with(table);
  std::vector<BeamCount> beams(cloud.size(), {100, 0});
  const Features rock = features_of(cloud, beams);
  const PointCloud block =
      ground_with([](float x, float y, float) { return inside(x, y) ? 0.4F : 0.0F; });
  const Features straight = features_of(block, beams);
  EXPECT_GT(rock[through_share], 0.5) << "the ground below it is seen";
  EXPECT_NEAR(rock[steepness], straight[steepness], 0.1 * straight[steepness]);

  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.z[i] > 0) beams[i] = {100, 30};
  }
  const Features tuft = features_of(cloud, beams);
  EXPECT_GT(tuft[through_share], 0.5);
  EXPECT_LT(tuft[steepness], 0.7 * straight[steepness]);
  EXPECT_LT(features_of(cloud)[steepness], 0.7 * straight[steepness])
      << "nothing is known without beams";
}

TEST(ClusterContext, ARocksEdgeIsHighAndAMoundsIsLow) {
  const Features slab =
      features_of(ground_with([](float x, float y, float) { return inside(x, y) ? 0.2F : 0.0F; }));
  EXPECT_NEAR(slab[edge_height], 0.2, 0.01);
  EXPECT_GT(slab[edge_share], 0.95);
  EXPECT_GT(slab[steepest], 0.6);
  EXPECT_LT(slab[steepness], 0.7 * slab[steepest]) << "its top is level";

  constexpr float kSlope = 0.45F;
  const Features mound = features_of(ground_with(
      [](float x, float y, float) { return std::max(0.3F - kSlope * std::hypot(x, y), 0.0F); }));
  EXPECT_LT(mound[edge_height], 0.12);
  EXPECT_LT(mound[edge_share], 0.1);
  EXPECT_NEAR(mound[steepest], kSlope, 0.1);

  const Features pit =
      features_of(ground_with([](float x, float y, float) { return inside(x, y) ? -0.2F : 0.0F; }));
  EXPECT_NEAR(pit[edge_height], 0.2, 0.01);
  EXPECT_GT(pit[edge_share], 0.95);
}

TEST(ClusterContext, MeasuresHowUnevenTheGroundAroundIs) {
  const auto rock_on = [](float unevenness) {
    return features_of(ground_with([=](float x, float y, float chance) {
      return inside(x, y) ? 0.4F : unevenness * (chance - 0.5F);
    }));
  };
  EXPECT_LT(rock_on(0)[roughness], 1e-4);
  const float uneven = rock_on(0.05F)[roughness];
  EXPECT_GT(uneven, 0.001);
  EXPECT_NEAR(rock_on(0.1F)[roughness] / uneven, 2, 0.4);
}

TEST(ClusterContext, MeasuresTheBoxAndTheSlope) {
  const Features rock =
      features_of(ground_with([](float x, float y, float) { return inside(x, y) ? 0.4F : 0.0F; }));
  EXPECT_NEAR(rock[box_length], 1.0, 0.1);
  EXPECT_NEAR(rock[box_width], 0.6, 0.1);
  EXPECT_NEAR(rock[max_height], 0.4, 0.02);
  EXPECT_GT(rock[steepness], 0.3);
  EXPECT_LT(rock[unseen_share], 0.05);
  EXPECT_GT(rock[ground_share], 0.6);
  EXPECT_EQ(rock[rim_share], 0);
}

TEST(ClusterContext, SeesWhatWasNotSeen) {
  const Features pit = features_of(ground_with([](float x, float y, float) {
    if (!inside(x, y)) return 0.0F;
    return x > 0 && y > 0 ? NAN : -0.5F;
  }));
  EXPECT_LT(pit[min_height], -0.4);
  EXPECT_NEAR(pit[unseen_share], 0.25, 0.1);
}

TEST(ClusterContext, ARimBordersOnItsHole) {
  const Features rim = features_of(ground_with([](float x, float y, float) {
    const float radius = std::hypot(x, y);
    if (radius < 0.3F) return -0.3F;
    return radius < 0.7F ? 0.3F : 0.0F;
  }));
  EXPECT_GT(rim[max_height], 0.2);
  EXPECT_GT(rim[rim_share], 0.3);
}

}  // namespace
}  // namespace scree
