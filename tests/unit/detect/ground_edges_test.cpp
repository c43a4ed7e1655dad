#include "scree/detect/ground_edges.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "detect/clouds.hpp"
#include "scree/core/sweep.hpp"

namespace scree {
namespace {

constexpr std::size_t kEdgePoints = 60'000, kEdgeCells = 1 << 16;

/// 12 x 10 m of this shape, seen evenly, NaN: nothing is seen; with noise of 5 mm.
PointCloud shaped(const std::function<float(float, float)>& height) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> along(-8, 4), across(-5, 5);
  std::normal_distribution<float> noise(0, 0.005F);
  PointCloud cloud(kEdgePoints + 2);
  for (std::size_t i = 0; i < kEdgePoints; ++i) {
    const float x = along(random), y = across(random), z = height(x, y);
    if (!std::isnan(z)) cloud.push_back(x, y, z + noise(random), 0);
  }
  return cloud;
}

class GroundEdgesTest : public testing::Test {
protected:
  std::span<const GroundEdge> edges_of(PointView cloud, std::span<const PassingBeam> lost = {}) {
    const Eigen::Vector3f sensor(-6, 0, 1);
    SeenCloud with_beams{.points = cloud};
    if (!lost.empty()) {
      with_beams.origins = {&sensor, 1};
      with_beams.passing = lost;
    }
    return edges_of(with_beams);
  }
  std::span<const GroundEdge> seen_from(const Eigen::Vector3f& sensor, PointView cloud) {
    return edges_of({.points = cloud, .origins = {&sensor, 1}});
  }
  std::span<const GroundEdge> edges_of(const SeenCloud& with_beams) {
    surface_.build(with_beams.points);
    evidence_.build(with_beams, surface_);
    edges_.find(surface_, evidence_);
    return edges_.all();
  }

  GroundSurface surface_{test::kGroundSettings, kEdgePoints + 2, kEdgeCells};
  HoleEvidence evidence_{kEdgeCells};
  GroundEdges edges_{kEdgeCells};
};

TEST_F(GroundEdgesTest, AStepDownIsOneEdgeBeyondTheGround) {
  for (const float step : {-0.2F, -0.5F, -1.5F}) {
    const auto edges = edges_of(shaped([&](float x, float) { return x < 2 ? 0.0F : step; }));
    ASSERT_EQ(edges.size(), 1U) << step;
    EXPECT_NEAR(edges[0].step, step, 0.05) << step;
    EXPECT_NEAR(edges[0].ground, 0, 0.02) << step;
    EXPECT_GT(edges[0].box.length, 9) << step;
    EXPECT_GE(edges[0].box.width, 0.3F) << step;
    EXPECT_NEAR(edges[0].box.center_x, 2.15, 0.15) << step;
    EXPECT_EQ(edges[0].evidence, Evidence::edge) << step;
  }
}

TEST_F(GroundEdgesTest, ADropWhoseFootIsHiddenIsToldByTheBeamsThatPassedOverIt) {
  const Eigen::Vector3f sensor(-2, 0, 1);
  const auto drop = [](float x, float) {
    if (x < 0) return 0.0F;
    return x < 1.6F ? NAN : -0.8F;  // as far as the edge hides it
  };
  const auto edges = seen_from(sensor, shaped(drop));
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_NEAR(edges[0].step, -0.8, 0.1);
  EXPECT_NEAR(edges[0].ground, 0, 0.02);
  EXPECT_GT(edges[0].box.length, 5);
  EXPECT_LT(edges[0].box.center_x - edges[0].box.width / 2, 0.4);
  EXPECT_TRUE(edges_of(shaped(drop)).empty()) << "without beams it may be a slope";
}

TEST_F(GroundEdgesTest, ACrestThatHidesTheSlopeBehindItIsNone) {
  const auto crest = [](float x, float) {
    const float z = std::max(-0.1F * x * x, -0.8F);
    if (x < 1.74F) return x < 0 ? 0.0F : z;
    return x < 3.17F ? NAN : -0.8F;
  };
  EXPECT_TRUE(seen_from({-2, 0, 1}, shaped(crest)).empty());
}

TEST_F(GroundEdgesTest, ReflectionsBelowAGapBetweenTheRingsAreNoDrop) {
  PointCloud cloud = shaped([](float x, float) { return x > 0 && x < 1 ? NAN : 0.0F; });
  PointCloud with_reflections(cloud.size() + 20);
  with_reflections.copy_from(cloud);
  for (int i = 0; i < 20; ++i) {
    with_reflections.push_back(1.3F, -1 + 0.1F * static_cast<float>(i), -0.8F, 0);
  }
  EXPECT_TRUE(seen_from({-2, 0, 1}, with_reflections).empty());
}

TEST_F(GroundEdgesTest, AStepUpToLevelGroundIsOneEdge) {
  // The lower ground is the larger one.
  const auto edges = edges_of(shaped([](float x, float) { return x < 2 ? 0.0F : 0.3F; }));
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_NEAR(edges[0].step, 0.3, 0.05);
  EXPECT_GT(edges[0].box.length, 9);
}

TEST_F(GroundEdgesTest, LowStepsSlopesAndHollowsAreNone) {
  EXPECT_TRUE(edges_of(shaped([](float x, float) { return x < 2 ? 0.0F : -0.1F; })).empty());
  EXPECT_TRUE(edges_of(shaped([](float x, float) { return 0.33F * x; })).empty());
  EXPECT_TRUE(edges_of(shaped([](float x, float) { return -0.33F * std::max(x, 0.0F); })).empty());
  for (const float sign : {-1.0F, 1.0F}) {
    EXPECT_TRUE(edges_of(shaped([&](float x, float y) {
                  const float share = std::min(std::hypot(x, y) / 2.5F, 1.0F);
                  return sign * 0.2F * (1 + std::cos(3.14159F * share));
                })).empty())
        << sign;
  }
}

TEST_F(GroundEdgesTest, ARockOnLevelGroundIsNone) {
  EXPECT_TRUE(edges_of(shaped([](float x, float y) {
                return std::abs(x) < 0.5F && std::abs(y) < 0.4F ? 0.6F : 0.0F;
              })).empty());
}

TEST_F(GroundEdgesTest, ReflectionsBelowSeenGroundAreNone) {
  PointCloud cloud = shaped([](float, float) { return 0.0F; });
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(0, 1), depth(-1.6F, -0.35F);
  for (int i = 0; i < 100; ++i) cloud.y[static_cast<std::size_t>(i)] = place(random);
  for (std::size_t i = 0; i < 100; ++i) {
    cloud.x[i] = place(random);
    cloud.z[i] = depth(random);
  }
  EXPECT_TRUE(edges_of(cloud).empty());
}

TEST_F(GroundEdgesTest, ReflectionsBelowGroundThatIsSeenThinlyAreNone) {
  // Four points in three cells, so that some cells hold reflections alone.
  std::mt19937 random(11);
  std::uniform_real_distribution<float> place(-4, 4), within(0, 2), depth(-1.6F, -0.35F);
  PointCloud cloud(kEdgePoints);
  for (int i = 0; i < 14'000; ++i) cloud.push_back(place(random), place(random), 0, 0);
  for (int i = 0; i < 700; ++i) {
    cloud.push_back(within(random), within(random) - 1, depth(random), 0);
  }
  EXPECT_TRUE(edges_of(cloud).empty());
}

TEST_F(GroundEdgesTest, ACornerIsPartedIntoItsTwoSides) {
  // The ground ends at a corner at (2, 3), or it ends but for a corner there.
  for (const bool is_outer : {true, false}) {
    const auto edges = edges_of(shaped([&](float x, float y) {
      const bool is_ground = is_outer ? x < 2 && y < 3 : x < 2 || y < 3;
      return is_ground ? 0.0F : -0.6F;
    }));
    ASSERT_GE(edges.size(), 2U) << is_outer;
    EXPECT_LE(edges.size(), 3U) << is_outer;
    for (const GroundEdge& edge : edges) {
      EXPECT_LT(edge.step, -0.5);
      EXPECT_LT(edge.box.width, 0.8F);
    }
  }
}

TEST_F(GroundEdgesTest, TheEdgeOfAWidePitStaysWhole) {
  const auto edges = edges_of(
      shaped([](float x, float y) { return test::in_square(x + 2, y, 2.5F) ? -0.8F : 0.0F; }));
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_NEAR(edges[0].box.length, 5, 0.5);
  EXPECT_NEAR(edges[0].box.width, 5, 0.5);
}

TEST_F(GroundEdgesTest, WhereNothingIsSeenLostBeamsTellOfAShadow) {
  const auto ground = [](float x, float) { return x < 2 ? 0.0F : std::nanf(""); };
  PointCloud cloud = shaped(ground);
  EXPECT_TRUE(edges_of(cloud).empty()) << "beams that are not known say nothing";
  const auto lost_from = [](float sensor_x) {
    std::vector<PassingBeam> lost;
    const Eigen::Vector3f sensor(sensor_x, 0, 1);
    for (float y = -4; y < 4; y += 0.02F) {
      for (float x = 2.1F; x < 3.5F; x += 0.2F) {
        lost.push_back({sensor, (Eigen::Vector3f(x, y, 0) - sensor).normalized(), kNoReturnRange});
      }
    }
    return lost;
  };
  // The raster ends with the points; two far beyond widen it.
  cloud.push_back(6, -5, 0, 0);
  cloud.push_back(6, 5, 0, 0);
  EXPECT_TRUE(edges_of(cloud, lost_from(-8)).empty()) << "so flat a beam passes gentle slopes, too";
  const auto edges = edges_of(cloud, lost_from(-4));
  ASSERT_EQ(edges.size(), 1U);
  EXPECT_EQ(edges[0].evidence, Evidence::shadow);
  EXPECT_LT(edges[0].step, -0.15);
  const OrientedBox& box = edges[0].box;
  EXPECT_NEAR(std::abs(box.yaw), 1.57, 0.05);
  EXPECT_NEAR(box.center_x - box.width / 2, 2, 0.2) << "it begins where the ground ends";
}

TEST_F(GroundEdgesTest, StillWaterFromWhichNothingComesBackIsNone) {
  const PointCloud cloud = shaped([](float x, float) { return x > -2 && x < 2 ? NAN : 0.0F; });
  const auto beams_of_range = [](float range) {
    std::vector<PassingBeam> beams;
    const Eigen::Vector3f sensor(-6, 0, 1);
    for (float y = -4; y < 4; y += 0.02F) {
      for (float x = -1.9F; x < 0; x += 0.2F) {
        beams.push_back({sensor, (Eigen::Vector3f(x, y, 0) - sensor).normalized(), range});
      }
    }
    return beams;
  };
  EXPECT_TRUE(edges_of(cloud, beams_of_range(kNoReturnRange)).empty());
  const auto edges = edges_of(cloud, beams_of_range(12));
  ASSERT_FALSE(edges.empty()) << "in a pit they end on its floor";
  EXPECT_EQ(edges[0].evidence, Evidence::shadow);
}

}  // namespace
}  // namespace scree
