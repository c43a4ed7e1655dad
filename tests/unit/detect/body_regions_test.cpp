#include "scree/detect/body_regions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "scree/detect/euclidean_clusters.hpp"
#include "scree/detect/surface_method.hpp"

namespace scree {
namespace {

constexpr float kBody = 0.06F, kTolerance = 0.3F, kSaddle = 0.4F;

/// Level ground of 6 m by 6 m with what stands on it.
class BodyRegionsTest : public ::testing::Test {
protected:
  using Height = std::function<float(float x, float y)>;  // NaN: not seen

  /// @param beams at a place; none: nothing is known of them
  void look_at(const Height& height, const std::function<BeamCount(float x, float y)>& beams = {}) {
    cloud_.clear();
    beams_.clear();
    bodies_.clear();
    constexpr float kStep = 0.04F, kReach = 3;
    for (float y = -kReach; y < kReach; y += kStep) {
      for (float x = -kReach; x < kReach; x += kStep) {
        const float z = height(x, y);
        if (std::isnan(z)) continue;
        cloud_.push_back(x, y, z, 0);
        if (beams) beams_.push_back(beams(x, y));
        if (std::abs(z) >= kBody) bodies_.push_back(cloud_, cloud_.size() - 1, 0, 0, z);
      }
    }
    surface_.build(cloud_);
    solidity_.build(cloud_, beams_, surface_, kBody, 2);
    regions_.label(bodies_, surface_, solidity_, {kTolerance, kSaddle});
  }

  std::uint32_t label_at(float x, float y) const {
    std::size_t nearest = 0;
    float least = INFINITY;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const float away = std::hypot(bodies_.points.x[i] - x, bodies_.points.y[i] - y);
      if (away < least) {
        least = away;
        nearest = i;
      }
    }
    return regions_.labels()[nearest];
  }

  PointCloud cloud_{1 << 16};
  std::vector<BeamCount> beams_;
  CandidatePoints bodies_{1 << 16};
  GroundSurface surface_{ground_surface_of(DetectSettings::for_map().surface), 1 << 16, 1 << 16};
  BeamGrid solidity_{1 << 16};
  BodyRegions regions_{1 << 16, 1 << 16};
};

float rock(float x, float y, float at_x, float radius, float height) {
  const float away = std::hypot(x - at_x, y) / radius;
  return away < 1 ? height * std::sqrt(1 - away * away) : 0;
}

TEST_F(BodyRegionsTest, SeenGroundPartsRocksThatAreNearerThanTheTolerance) {
  look_at([](float x, float y) {
    return std::max(rock(x, y, -0.5F, 0.4F, 0.3F), rock(x, y, 0.5F, 0.4F, 0.3F));
  });
  EXPECT_EQ(regions_.sizes().size(), 2U);
  EXPECT_NE(label_at(-0.5F, 0), label_at(0.5F, 0));
}

TEST_F(BodyRegionsTest, WhatWasNotSeenPartsNothing) {
  const auto with_gap = [](float gap) {
    return
        [gap](float x, float y) { return std::abs(x) < gap / 2 ? NAN : rock(x, y, 0, 0.8F, 0.3F); };
  };
  look_at(with_gap(0.2F));
  EXPECT_EQ(regions_.sizes().size(), 1U);
  look_at(with_gap(0.6F));
  EXPECT_EQ(regions_.sizes().size(), 2U) << "wider than the tolerance";
}

TEST_F(BodyRegionsTest, RocksThatTouchArePartedAtTheSaddle) {
  const auto two_tops = [](float saddle) {
    return [saddle](float x, float y) {
      const float tops = std::max(rock(x, y, -0.5F, 0.45F, 0.6F), rock(x, y, 0.5F, 0.45F, 0.4F));
      return std::abs(x) < 0.5F && std::abs(y) < 0.2F ? std::max(tops, saddle) : tops;
    };
  };
  look_at(two_tops(0.1F));
  EXPECT_EQ(regions_.sizes().size(), 2U);
  EXPECT_NE(label_at(-0.5F, 0), label_at(0.5F, 0));
  look_at(two_tops(0.3F));
  EXPECT_EQ(regions_.sizes().size(), 1U) << "the saddle is higher than its share of the lower top";
}

TEST_F(BodyRegionsTest, RocksRiseOutOfTheGrassThatJoinsThem) {
  const auto is_rock = [](float x, float y) {
    return rock(x, y, -0.5F, 0.3F, 0.3F) + rock(x, y, 0.5F, 0.3F, 0.3F) > 0;
  };
  const auto height = [&](float x, float y) {
    if (is_rock(x, y)) return 0.3F;
    return std::abs(x) < 1 && std::abs(y) < 0.4F ? 0.25F : 0.0F;
  };
  look_at(height);
  EXPECT_EQ(regions_.sizes().size(), 1U) << "nothing is known of the beams";
  look_at(height, [](float, float) { return BeamCount{20, 0}; });
  EXPECT_EQ(regions_.sizes().size(), 1U) << "a wall between them";
  look_at(height, [&](float x, float y) {
    return is_rock(x, y) ? BeamCount{20, 0} : BeamCount{20, 40};
  });
  EXPECT_EQ(regions_.sizes().size(), 2U);
  EXPECT_NE(label_at(-0.5F, 0), label_at(0.5F, 0));
}

TEST_F(BodyRegionsTest, ARockIsPartedFromTheGrassAroundItWhateverItsHeight) {
  const auto is_rock = [](float x, float y) { return std::hypot(x, y) < 0.35F; };
  for (const float top : {0.15F, 0.2F, 0.5F}) {
    const auto height = [&](float x, float y) {
      if (is_rock(x, y)) return top;
      return std::abs(x) < 1 && std::abs(y) < 0.6F ? 0.2F : 0.0F;
    };
    const auto beams = [&](float x, float y) {
      return is_rock(x, y) ? BeamCount{20, 0, 0.2F} : BeamCount{20, 0, 1};
    };
    look_at(height, beams);
    EXPECT_EQ(regions_.sizes().size(), 2U) << top;
    EXPECT_NE(label_at(0, 0), label_at(0.7F, 0)) << top;
    EXPECT_EQ(label_at(-0.7F, 0), label_at(0.7F, 0)) << "grass on both sides, " << top;
  }
}

TEST_F(BodyRegionsTest, ALowRidgeOfUnevenHeightStaysWhole) {
  look_at([](float x, float y) {
    return std::abs(y) < 0.15F && std::abs(x) < 1.5F ? 0.11F + 0.04F * std::sin(9 * x) : 0.0F;
  });
  EXPECT_EQ(regions_.sizes().size(), 1U);
}

TEST_F(BodyRegionsTest, AHoleAndTheRockOnItsRimAreTwo) {
  look_at([](float x, float y) {
    return rock(x, y, 0.4F, 0.4F, 0.4F) - rock(x, y, -0.4F, 0.4F, 0.4F);
  });
  EXPECT_EQ(regions_.sizes().size(), 2U);
  EXPECT_NE(label_at(-0.4F, 0), label_at(0.4F, 0));
}

TEST_F(BodyRegionsTest, HolesAreNotPartedByTheirDepth) {
  look_at([](float x, float y) {
    const float deep = std::min(-rock(x, y, -0.5F, 0.45F, 0.6F), -rock(x, y, 0.5F, 0.45F, 0.4F));
    return std::abs(x) < 0.5F && std::abs(y) < 0.2F ? std::min(deep, -0.1F) : deep;
  });
  EXPECT_EQ(regions_.sizes().size(), 1U);
}

TEST_F(BodyRegionsTest, FarApartItAgreesWithEuclideanClusters) {
  look_at([](float x, float y) {
    float height = 0;
    for (const float at : {-2.0F, 0.0F, 2.0F})
      height = std::max(height, rock(x, y, at, 0.4F, 0.3F));
    return height;
  });
  EuclideanClusters euclidean(1 << 16);
  euclidean.cluster(bodies_.points, kTolerance);
  ASSERT_EQ(regions_.sizes().size(), euclidean.sizes().size());
  std::map<std::uint32_t, std::set<std::uint32_t>> partners;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    partners[euclidean.labels()[i]].insert(regions_.labels()[i]);
  }
  for (const auto& [label, others] : partners) EXPECT_EQ(others.size(), 1U) << label;
}

TEST_F(BodyRegionsTest, NothingGivesNoRegion) {
  look_at([](float, float) { return 0.0F; });
  EXPECT_EQ(regions_.sizes().size(), 0U);
  EXPECT_TRUE(regions_.labels().empty());
}

}  // namespace
}  // namespace scree
