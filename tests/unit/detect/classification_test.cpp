#include "scree/detect/classification.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace scree {
namespace {

/// A network that says the same of every cluster: sigmoids of these.
Network saying(double positive, double negative) {
  Network network(1);
  std::ranges::fill(network.weights(), 0.0);
  network.weights()[network.output_row(0) + 1] = positive;
  network.weights()[network.output_row(1) + 1] = negative;
  return network;
}

constexpr double kYes = 5, kNo = -5;

class Classification : public testing::Test {
protected:
  Classification() : points_(kPoints), clusters_(kPoints), polygons_(kPoints), obstacles_(4) {
    PointCloud one(1);
    for (int i = 0; i < kPoints; ++i) {
      one.clear();
      one.push_back(0.1F * static_cast<float>(i % 8), 0.1F * static_cast<float>(i / 8), 0, 0);
      points_.push_back(one, 0, 0, 0, 0);
    }
    const std::vector<std::uint32_t> labels(kPoints, 0), sizes = {kPoints};
    clusters_.gather(points_, labels, sizes, 1);
  }

  Cluster& cluster() { return clusters_.all()[0]; }

  /// Lets a cluster reach from one height to another above the ground.
  void stand(float low, float high) {
    cluster().lowest = low;
    cluster().highest = high;
    cluster().features[min_height] = low;
    cluster().features[max_height] = high;
  }

  const FixedVector<Obstacle>& obstacles(const Network& network) {
    StageCounts counts;
    classify({points_, clusters_}, network, 0.5, Eigen::Vector2f::Zero(), polygons_, obstacles_,
             counts);
    return obstacles_;
  }

  static constexpr int kPoints = 64;
  CandidatePoints points_;
  Clusters clusters_;
  EnclosingPolygons polygons_;
  FixedVector<Obstacle> obstacles_;
};

TEST_F(Classification, KindAndSignOfHeightAgree) {
  stand(0, 0.4F);
  ASSERT_EQ(obstacles(saying(kYes, kNo)).size(), 1U);
  EXPECT_EQ(obstacles_[0].kind, ObstacleKind::positive);
  EXPECT_FLOAT_EQ(static_cast<float>(obstacles_[0].height), 0.4F);
  cluster().evidence = Evidence::inside;
  EXPECT_TRUE(obstacles(saying(kNo, kYes)).empty()) << "a hole above the ground";
  stand(-0.4F, -0.1F);
  EXPECT_TRUE(obstacles(saying(kYes, kNo)).empty()) << "a rock below the ground";
  ASSERT_EQ(obstacles(saying(kNo, kYes)).size(), 1U);
  EXPECT_EQ(obstacles_[0].kind, ObstacleKind::negative);
  EXPECT_FLOAT_EQ(static_cast<float>(obstacles_[0].height), -0.4F);
  EXPECT_EQ(obstacles_[0].evidence, Evidence::inside);
}

TEST_F(Classification, AHoleWithoutEvidenceIsNone) {
  stand(-0.4F, -0.1F);
  EXPECT_TRUE(obstacles(saying(kNo, kYes)).empty());
}

TEST_F(Classification, WhatStandsTallIsInTheWayWhateverTheNetworkSays) {
  stand(0.2F, 1.3F);
  cluster().evidence = Evidence::inside;
  for (const Network& network : {saying(kNo, kNo), saying(kNo, kYes), saying(kYes, kNo)}) {
    ASSERT_EQ(obstacles(network).size(), 1U);
    EXPECT_EQ(obstacles_[0].kind, ObstacleKind::positive);
  }
  stand(0.2F, 0.9F);
  EXPECT_TRUE(obstacles(saying(kNo, kNo)).empty());
}

TEST_F(Classification, WhatHangsAboveSeenGroundIsInTheWay) {
  stand(0.5F, 0.7F);
  EXPECT_TRUE(obstacles(saying(kNo, kNo)).empty()) << "no ground is known below it";
  cluster().features[ground_share] = 0.8F;
  for (const Network& network : {saying(kNo, kNo), saying(kNo, kYes)}) {
    ASSERT_EQ(obstacles(network).size(), 1U);
    EXPECT_EQ(obstacles_[0].kind, ObstacleKind::positive);
  }
}

TEST_F(Classification, GroundOnAHigherLevelIsNone) {
  stand(0.2F, 0.4F);
  cluster().is_terrace = true;
  EXPECT_TRUE(obstacles(saying(kYes, kNo)).empty());
}

}  // namespace
}  // namespace scree
