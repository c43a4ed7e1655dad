#include "scree/terrain/voxel_walk.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace scree {
namespace {

/// The occupied voxels along a beam, looking into the voxel at every step.
std::vector<VoxelKey> step_by_step(const VoxelHashMap& map, const VoxelWalk& walk, int steps) {
  std::vector<VoxelKey> met;
  for (int step = 0; step < steps; ++step) {
    const VoxelKey key = VoxelKey::at(walk.at(step));
    if (map.find(key) != nullptr && (met.empty() || met.back() != key)) met.push_back(key);
  }
  return met;
}

std::vector<VoxelKey> by_leaps(const VoxelHashMap& map, const VoxelWalk& walk, int steps) {
  std::vector<VoxelKey> met;
  walk.for_each_voxel(map, steps, [&](int, const VoxelKey& key) {
    if (map.find(key) != nullptr && (met.empty() || met.back() != key)) met.push_back(key);
  });
  return met;
}

TEST(VoxelWalk, MeetsTheSameVoxelsByLeapsAsStepByStep) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> cell(-60, 60);
  std::normal_distribution<float> normal;
  VoxelHashMap map(3000);
  for (int i = 0; i < 3000; ++i) {
    map.find_or_add(VoxelKey().shifted(cell(random), cell(random), cell(random) / 4));
  }
  std::size_t met = 0;
  for (int i = 0; i < 3000; ++i) {
    Eigen::Vector3f along(normal(random), normal(random), 0.2F * normal(random));
    if (i % 10 == 0) along = Eigen::Vector3f::Unit(i / 10 % 3);
    const Eigen::Vector3f from(30 * normal(random), 30 * normal(random), normal(random));
    const VoxelWalk walk(from, along.normalized());
    const auto expected = step_by_step(map, walk, 150);
    EXPECT_EQ(by_leaps(map, walk, 150), expected) << i;
    met += expected.size();
  }
  EXPECT_GT(met, 500U);
}

}  // namespace
}  // namespace scree
