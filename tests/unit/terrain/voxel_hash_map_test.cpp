#include "scree/terrain/voxel_hash_map.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

namespace scree {
namespace {

using Reference = std::map<std::tuple<int, int, int>, std::uint8_t>;

bool may_hold(const VoxelHashMap& map, const VoxelKey& key) {
  const VoxelHashMap::BlockKey block = VoxelHashMap::BlockKey::of(key);
  return VoxelHashMap::may_hold(block, map.voxels_in(block), key);
}

void expect_same(const VoxelHashMap& map, const Reference& reference) {
  ASSERT_EQ(map.size(), reference.size());
  for (const auto& [key, hits] : reference) {
    const auto [x, y, z] = key;
    const VoxelKey voxel{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y),
                         static_cast<std::int16_t>(z)};
    ASSERT_NE(map.find(voxel), nullptr);
    EXPECT_EQ(map.find(voxel)->hits, hits);
    EXPECT_TRUE(may_hold(map, voxel));
  }
}

TEST(VoxelHashMap, KnowsWhichVoxelsABlockMayHold) {
  VoxelHashMap map(10);
  map.find_or_add({1, 1, 1});
  EXPECT_TRUE(may_hold(map, {1, 1, 1}));
  EXPECT_FALSE(may_hold(map, {2, 1, 1}));
  EXPECT_FALSE(may_hold(map, {5, 1, 1}));
  const VoxelHashMap::BlockKey first = VoxelHashMap::BlockKey::of({1, 1, 1});
  EXPECT_NE(map.voxels_in(first), 0U);
  EXPECT_FALSE(VoxelHashMap::may_hold(first, map.voxels_in(first), {5, 1, 1}));
  EXPECT_EQ(map.voxels_in(VoxelHashMap::BlockKey::of({-1, 1, 1})), 0U);
}

TEST(VoxelHashMap, VoxelsFarOffMayGoWithoutHidingOthers) {
  VoxelHashMap map(10);
  map.find_or_add({1, 1, 1});
  map.find_or_add({513, 1, 1});  // the same place in the masks
  map.erase(0, 1);
  EXPECT_EQ(map.find({1, 1, 1}), nullptr);
  EXPECT_NE(map.find({513, 1, 1}), nullptr);
  EXPECT_TRUE(may_hold(map, {513, 1, 1}));
  map.erase(0, 1);
  EXPECT_EQ(map.find({513, 1, 1}), nullptr);
  EXPECT_FALSE(may_hold(map, {513, 1, 1}));
}

TEST(VoxelHashMap, WhatChangesIsNotedForAllAroundIt) {
  std::mt19937 random(4);
  std::uniform_int_distribution<int> number(-100, 100);
  VoxelHashMap map(10);
  for (std::uint32_t sweep = 1; sweep <= 200; ++sweep) {
    const VoxelKey key = VoxelKey().shifted(number(random), number(random), number(random) / 4);
    map.find_or_add(key);
    map.grow(key, sweep);
    const bool erases = sweep % 2 == 0;
    if (erases) map.erase(0, sweep);
    for (int i = 0; i < 27; ++i) {
      const auto changes = map.changes(key.shifted(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
      ASSERT_EQ(changes.grown, sweep);
      ASSERT_EQ(changes.erased == sweep, erases);
    }
    ASSERT_NE(map.changes(key.shifted(8, 0, 0)).grown, sweep);
    if (!erases) map.erase(0, 0);
  }
  map.shift(256, 0, 0, 201);
  EXPECT_EQ(map.changes({5, 5, 5}).grown, 201U);
  EXPECT_EQ(map.changes({5, 5, 5}).erased, 201U);
}

TEST(VoxelHashMap, HoldsWhatAPlainMapHolds) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> number(-20, 20), choice(0, 99);
  VoxelHashMap map(500);
  Reference reference;
  for (int i = 0; i < 20'000; ++i) {
    const int x = number(random), y = number(random), z = number(random) / 8;
    const VoxelKey key = VoxelKey().shifted(x, y, z);
    if (choice(random) < 40 && map.size() > 0) {
      const std::size_t index = random() % map.size();
      const VoxelKey& erased = map[index].key;
      reference.erase({erased.x, erased.y, erased.z});
      map.erase(index, 1);
    } else if (MapVoxel* const voxel = map.find_or_add(key); voxel != nullptr) {
      reference[{x, y, z}] = ++voxel->hits;
    } else {
      EXPECT_EQ(map.size(), map.capacity());
      EXPECT_FALSE(reference.contains({x, y, z}));
    }
  }
  expect_same(map, reference);

  map.shift(100, -1000, 7, 1);
  Reference shifted;
  for (const auto& [key, hits] : reference) {
    const auto [x, y, z] = key;
    shifted[{x + 100, y - 1000, z + 7}] = hits;
  }
  expect_same(map, shifted);

  map.clear();
  expect_same(map, {});
  EXPECT_FALSE(may_hold(map, {100, -1000, 7}));
}

}  // namespace
}  // namespace scree
