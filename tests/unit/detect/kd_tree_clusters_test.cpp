#include "scree/detect/kd_tree_clusters.hpp"

#include <gtest/gtest.h>

#include <random>

#include "allocation_counter.hpp"
#include "scree/detect/euclidean_clusters.hpp"

namespace scree {
namespace {

/// Clumps of points, some of them in one place.
PointCloud clumps(std::size_t points, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-6, 6);
  std::normal_distribution<float> spread(0, 0.2F);
  PointCloud cloud(points);
  float x = 0, y = 0, z = 0;
  while (cloud.size() < points) {
    if (cloud.size() % 40 == 0) {
      x = place(random);
      y = place(random);
      z = place(random) / 8;
    }
    const float scale = cloud.size() % 3 == 0 ? 0.0F : 1.0F;
    cloud.push_back(x + scale * spread(random), y + scale * spread(random),
                    z + scale * spread(random), 0);
  }
  return cloud;
}

void expect_the_grids_answer(PointView cloud, float tolerance, KdTreeClusters& tree) {
  EuclideanClusters grid(cloud.size());
  grid.cluster(cloud, tolerance);
  tree.cluster(cloud, tolerance);
  EXPECT_TRUE(std::ranges::equal(tree.labels(), grid.labels())) << tolerance;
  EXPECT_TRUE(std::ranges::equal(tree.sizes(), grid.sizes())) << tolerance;
}

TEST(KdTreeClusters, AgreesWithTheGridLabelByLabel) {
  KdTreeClusters tree(4000);
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const PointCloud cloud = clumps(200 * seed, seed);
    for (const float tolerance : {0.02F, 0.1F, 0.3F, 2.0F}) {
      expect_the_grids_answer(cloud, tolerance, tree);
    }
  }
}

TEST(KdTreeClusters, TakesCloudsThatNoPlaneParts) {
  KdTreeClusters tree(3000);
  PointCloud cloud(3000);
  expect_the_grids_answer(cloud, 0.1F, tree);
  EXPECT_TRUE(tree.sizes().empty());
  cloud.push_back(1, 2, 3, 0);
  expect_the_grids_answer(cloud, 0.1F, tree);
  while (cloud.push_back(1, 2, 3, 0)) {
  }
  expect_the_grids_answer(cloud, 0.1F, tree);
  EXPECT_EQ(tree.sizes().size(), 1U);
  // Each a little farther out than the one before: no tree of these is balanced.
  cloud.clear();
  for (float x = 1e-6F; x < 100; x *= 1.05F) cloud.push_back(x, 0, 0, 0);
  expect_the_grids_answer(cloud, 0.05F, tree);
}

TEST(KdTreeClusters, APointExactlyAtTheToleranceBelongs) {
  PointCloud cloud(3);
  cloud.push_back(0, 0, 0, 0);
  cloud.push_back(0.5F, 0, 0, 0);
  cloud.push_back(1.25F, 0, 0, 0);
  KdTreeClusters tree(3);
  tree.cluster(cloud, 0.5F);
  EXPECT_EQ(tree.sizes().size(), 2U);
}

TEST(KdTreeClusters, AllocatesNothingAfterTheStart) {
  const PointCloud cloud = clumps(4000, 1);
  KdTreeClusters tree(4000);
  const std::size_t before = test::allocations();
  tree.cluster(cloud, 0.1F);
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace scree
