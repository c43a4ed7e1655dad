#include "scree/detect/detector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "allocation_counter.hpp"
#include "detect/clouds.hpp"

namespace scree {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

constexpr DetectorLimits kLimits{
    .points = 60'000, .candidates = 30'000, .ground_cells = 1 << 15, .obstacles = 16};

/// A network that takes more acute than obtuse angles for a positive obstacle, and the other way
/// round; nothing for a cluster without height or depth.
Network by_angles() {
  Network network(2);
  const auto weights = network.weights();
  std::ranges::fill(weights, 0.0);
  weights[acute_count] = 1;  // hidden unit 0: acute over obtuse
  weights[obtuse_count] = -1;
  weights[kPaperFeatures + 1 + acute_count] = -1;  // hidden unit 1: the reverse
  weights[kPaperFeatures + 1 + obtuse_count] = 1;
  for (std::size_t output = 0; output < 2; ++output) {
    weights[network.output_row(output) + output] = 20;
    weights[network.output_row(output) + 2] = -12;
  }
  return network;
}

struct Found {
  StageCounts counts;
  FixedVector<Obstacle> obstacles{16};
};

Found run(PointView cloud, const DetectSettings& settings, const DetectorLimits& limits = kLimits) {
  Found found;
  Detector detector(settings, limits, by_angles());
  detector.detect(cloud, found.obstacles);
  found.counts = detector.counts();
  return found;
}

/// The paper's chain, and ours with the ground's surface.
class EachMethod : public testing::TestWithParam<DetectSettings (*)()> {
protected:
  static DetectSettings settings_for_test() { return GetParam()(); }
  /// The method with each of its ways to cluster.
  static std::vector<DetectSettings> both_clusterings() {
    std::vector<DetectSettings> both(2, GetParam()());
    both[0].edges.clustering = EdgeClustering::supervoxel;
    both[1].edges.clustering = EdgeClustering::euclidean;
    both[0].surface.clustering = SurfaceClustering::regions;
    both[1].surface.clustering = SurfaceClustering::euclidean;
    return both;
  }
  static Found detect(PointView cloud) { return run(cloud, settings_for_test()); }
  static Found detect(PointView cloud, const DetectSettings& settings,
                      const DetectorLimits& limits = kLimits) {
    return run(cloud, settings, limits);
  }
};
INSTANTIATE_TEST_SUITE_P(Detector, EachMethod,
                         testing::Values(&DetectSettings::for_paper, &DetectSettings::for_cloud),
                         [](const auto& method) {
                           return method.index == 0 ? "edges" : "surface";
                         });

TEST_P(EachMethod, FindsTheBumpAndTheBowl) {
  const PointCloud cloud = test::bump_and_bowl(50'000);
  const Found found = detect(cloud);
  ASSERT_EQ(found.obstacles.size(), 2U);
  for (const Obstacle& obstacle : found.obstacles) {
    const bool is_bump = obstacle.center.x() > 0;
    EXPECT_EQ(obstacle.kind, is_bump ? ObstacleKind::positive : ObstacleKind::negative);
    EXPECT_NEAR(obstacle.center.x(), is_bump ? test::kBumpX : test::kBowlX, 0.15);
    EXPECT_NEAR(obstacle.center.y(), 0, 0.15);
    EXPECT_NEAR(obstacle.extent.x(), 2 * test::kRoundRadius, 0.4);
    EXPECT_GT(std::abs(obstacle.height), 0.15);
    EXPECT_LT(std::abs(obstacle.height), test::kRoundHeight + 0.05);
    EXPECT_EQ(obstacle.height > 0, is_bump);
    EXPECT_GT(obstacle.confidence, 0.5);
    EXPECT_GT(obstacle.points, 20U);
    EXPECT_EQ(obstacle.evidence, is_bump ? Evidence::none : Evidence::inside);
  }
  EXPECT_EQ(found.obstacles[0].id, 1);
  EXPECT_EQ(found.obstacles[1].id, 2);
}

TEST_P(EachMethod, AFootprintHoldsThePointsOfItsCluster) {
  const PointCloud cloud = test::bump_and_bowl(50'000);
  FixedVector<Obstacle> obstacles(16);
  Detector detector(settings_for_test(), kLimits, by_angles());
  detector.detect(cloud, obstacles);
  const auto [points, clusters] = detector.clustered();
  for (const Obstacle& obstacle : obstacles) {
    const auto cluster = std::ranges::find_if(clusters.all(), [&](const Cluster& each) {
      return each.box.center_x == static_cast<float>(obstacle.center.x());
    });
    ASSERT_NE(cluster, clusters.all().end());
    std::size_t inside = 0;
    for (const std::uint32_t i : clusters.members(*cluster)) {
      // A hair towards the middle: points of the hull lie on the boundary.
      const Eigen::Vector2d place(points.points.x[i], points.points.y[i]);
      if (obstacle.footprint.contains(place + 1e-6 * (obstacle.center.head<2>() - place))) ++inside;
    }
    EXPECT_EQ(inside, obstacle.points);
    const Eigen::Vector2d beyond(obstacle.center.x() + 0.55 * obstacle.extent.x(),
                                 obstacle.center.y() + 0.55 * obstacle.extent.y());
    EXPECT_FALSE(obstacle.footprint.contains(beyond));
  }
}

TEST(EdgeMethod, FindsThemWithoutEachOfTheStagesThatCanBeLeftOut) {
  const PointCloud cloud = test::bump_and_bowl(50'000);
  for (int stages = 0; stages < 8; ++stages) {
    DetectSettings settings = DetectSettings::for_paper();
    const bool has_voxel_grid = (stages & 1) != 0;
    if (!has_voxel_grid) settings.leaf_size = 0;
    settings.edges.suppression = (stages & 2) != 0;
    if ((stages & 4) == 0) {
      settings.edges.clustering = EdgeClustering::euclidean;
      settings.edges.min_cluster_size = 30;
    }
    const Found found = run(cloud, settings);
    EXPECT_EQ(found.obstacles.size(), 2U) << stages;
    EXPECT_EQ(found.counts.voxels < cloud.size(), has_voxel_grid) << stages;
    EXPECT_EQ(found.counts.kept < found.counts.candidates, settings.edges.suppression) << stages;
    EXPECT_EQ(found.counts.blocks > 0, (stages & 4) != 0) << stages;
  }
}

TEST_P(EachMethod, TwiceTheSameAndNothingAllocatedTheSecondTime) {
  const PointCloud cloud = test::bump_and_bowl(50'000);
  for (const DetectSettings& settings : both_clusterings()) {
    Detector detector(settings, kLimits, by_angles());
    FixedVector<Obstacle> first(16), second(16);
    detector.detect(cloud, first);
    const std::size_t before = test::allocations();
    detector.detect(cloud, second);
    EXPECT_EQ(test::allocations(), before);
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i].center, second[i].center);
      EXPECT_EQ(first[i].confidence, second[i].confidence);
      EXPECT_EQ(first[i].points, second[i].points);
      EXPECT_TRUE(std::ranges::equal(first[i].footprint, second[i].footprint));
    }
  }
}

TEST_P(EachMethod, SurvivesCloudsWithNothingInThem) {
  PointCloud cloud(60'000);
  EXPECT_TRUE(detect(cloud).obstacles.empty());
  cloud.push_back(1, 2, 3, 4);
  EXPECT_TRUE(detect(cloud).obstacles.empty());
  while (cloud.push_back(1, 2, 3, 4)) {
  }
  DetectorLimits limits = kLimits;
  limits.points = limits.candidates = 2000;
  for (const double leaf_size : {0.05, 0.0}) {
    for (DetectSettings settings : both_clusterings()) {
      settings.leaf_size = leaf_size;
      settings.edges.threshold = 0;
      const Found found = detect(cloud, settings, limits);
      EXPECT_TRUE(found.obstacles.empty());
      EXPECT_EQ(found.counts.dropped, cloud.size() - 2000);
    }
  }
}

TEST_P(EachMethod, RefusesWhatIsNotFiniteOrTooFarOut) {
  PointCloud cloud = test::bump_and_bowl(50'000);
  const Found clean = detect(cloud);
  PointCloud dirty(60'000);
  const float bad[] = {kNan, kInf, -kInf, 1e30F, -1e9F, 3.4e38F};
  std::size_t added = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (i % 1000 == 0) {
      for (const float value : bad) {
        dirty.push_back(value, 0, 0, 0);
        dirty.push_back(0, value, 0, 0);
        dirty.push_back(0, 0, value, 0);
        added += 3;
      }
    }
    dirty.push_back(cloud.x[i], cloud.y[i], cloud.z[i], cloud.reflectivity[i]);
  }
  for (const double leaf_size : {0.0592, 0.0}) {
    DetectSettings settings = settings_for_test();
    settings.leaf_size = leaf_size;
    const Found found = detect(dirty, settings);
    EXPECT_EQ(found.counts.refused, added);
    EXPECT_EQ(found.obstacles.size(), clean.obstacles.size());
  }
}

TEST_P(EachMethod, ReflectivityThatIsNotANumberDoesNotSpread) {
  PointCloud cloud = test::bump_and_bowl(50'000);
  for (std::size_t i = 0; i < cloud.size(); i += 3) cloud.reflectivity[i] = kNan;
  const Found found = detect(cloud);
  EXPECT_EQ(found.obstacles.size(), 2U);
}

TEST_P(EachMethod, WorksAtTheRimOfItsCells) {
  // Far from the origin, up to where the cells end; beyond, every point is refused.
  DetectSettings settings = settings_for_test();
  const PointCloud cloud = test::bump_and_bowl(50'000);
  for (const float shift : {-400.0F, 400.0F, 5000.0F}) {
    PointCloud moved(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      moved.push_back(cloud.x[i] + shift, cloud.y[i] - shift, cloud.z[i], 0);
    }
    const Found found = detect(moved, settings);
    if (std::abs(shift) < 1000) {
      EXPECT_EQ(found.obstacles.size(), 2U) << shift;
    } else {
      EXPECT_EQ(found.counts.refused, cloud.size());
    }
  }
}

TEST_P(EachMethod, PassesUnderWhatHangsHighAboveTheGround) {
  // A ceiling over everything, a branch over the bump, and two stray points far below the ground.
  const PointCloud cloud = test::bump_and_bowl(40'000);
  PointCloud covered(60'000);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    covered.push_back(cloud.x[i], cloud.y[i], cloud.z[i], 0);
    if (i % 4 == 0) covered.push_back(cloud.x[i], cloud.y[i], cloud.z[i] + 2.6F, 0);
  }
  covered.push_back(test::kBumpX, 0.1F, -3, 0);
  covered.push_back(test::kBumpX, 0.3F, -4, 0);
  EXPECT_EQ(detect(covered).obstacles.size(), 2U);
  DetectSettings settings = settings_for_test();
  settings.clearance = 0;
  EXPECT_EQ(detect(covered, settings).counts.below_clearance,
            detect(covered, settings).counts.voxels);
}

TEST(SurfaceMethod, PointsThatFloatAloneDoNotStretchTheRockBelow) {
  PointCloud cloud = test::bump_and_bowl(50'000);
  const DetectSettings settings = DetectSettings::for_cloud();
  const Found clean = run(cloud, settings);
  PointCloud dusty(60'000);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    dusty.push_back(cloud.x[i], cloud.y[i], cloud.z[i], 0);
  }
  dusty.push_back(test::kBumpX, 0, test::kRoundHeight + 1, 0);
  dusty.push_back(test::kBowlX, 0, -test::kRoundHeight - 1, 0);
  const Found found = run(dusty, settings);
  ASSERT_EQ(found.obstacles.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(found.obstacles[i].height, clean.obstacles[i].height, 0.02);
  }
}

TEST(SurfaceMethod, RocksAHandApartStayTwo) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> place(-4, 4);
  PointCloud cloud(50'000);
  while (cloud.size() < cloud.capacity()) {
    const float x = place(random), y = place(random);
    const auto cap = [&](float center) {
      const float distance = std::hypot(x - center, y) / 0.4F;
      return distance < 1 ? std::sqrt(1 - distance) : 0.0F;
    };
    cloud.push_back(x, y, 0.2F * x + cap(-0.55F) + cap(0.55F), 0);
  }
  EXPECT_EQ(run(cloud, DetectSettings::for_cloud()).obstacles.size(), 2U);
}

TEST_P(EachMethod, CountsWhatDoesNotFit) {
  const PointCloud cloud = test::bump_and_bowl(60'000);
  DetectorLimits limits = kLimits;
  limits.points = 50'000;
  EXPECT_EQ(detect(cloud, settings_for_test(), limits).counts.dropped, 10'000U);
  limits = kLimits;
  limits.candidates = 100;
  const Found few = detect(cloud, settings_for_test(), limits);
  EXPECT_EQ(few.counts.candidates_dropped, few.counts.candidates - 100);
  Detector detector(settings_for_test(), kLimits, by_angles());
  FixedVector<Obstacle> one(1);
  detector.detect(cloud, one);
  EXPECT_GE(detector.counts().obstacles, 2U);
  EXPECT_EQ(detector.counts().obstacles_dropped, detector.counts().obstacles - 1);
}

TEST_P(EachMethod, SurvivesExtremeSettings) {
  const PointCloud cloud = test::bump_and_bowl(5'000);
  for (const double length : {0.001, 10.0}) {
    DetectSettings settings = settings_for_test();
    EdgeSettings& edges = settings.edges;
    settings.leaf_size = edges.kernel.spacing = edges.kernel.radius = length;
    edges.suppression_distance = edges.suppression_radius = length;
    edges.voxel_size = edges.seed_distance = edges.cluster_tolerance = length;
    edges.threshold = 0;
    settings.surface.cluster_tolerance = length;
    for (const double bandwidth : {0.05, 100.0}) {
      edges.kernel.bandwidth = bandwidth;
      settings.surface.kernel = edges.kernel;
      const Found found = detect(cloud, settings);
      EXPECT_EQ(found.counts.input, 5'000U);
    }
  }
}

}  // namespace
}  // namespace scree
