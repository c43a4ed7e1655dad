#include "scree/terrain/voxel_hash_map.hpp"

#include <bit>

namespace scree {

VoxelHashMap::VoxelHashMap(std::size_t capacity)
    : voxels_(capacity),
      numbers_(std::bit_ceil(2 * capacity)),
      mask_(numbers_.capacity() - 1),
      masks_(BlockGrid::kSlots),
      blocks_(BlockGrid::kSlots / 64),
      in_block_(BlockGrid::kSlots),
      changes_(BlockGrid::kSlots) {
  clear();
}

void VoxelHashMap::clear() {
  voxels_.clear();
  clear_index();
}

void VoxelHashMap::clear_index() {
  numbers_.assign(numbers_.capacity(), 0);
  masks_.assign(masks_.capacity(), 0);
  blocks_.assign(blocks_.capacity(), 0);
  in_block_.assign(in_block_.capacity(), 0);
  changes_.assign(changes_.capacity(), {});
}

void VoxelHashMap::index(std::size_t voxel, std::size_t slot) {
  numbers_[slot] = static_cast<std::uint32_t>(voxel + 1);
  voxels_[voxel].slot = static_cast<std::uint32_t>(slot);
}

void VoxelHashMap::count(const VoxelKey& key) {
  const std::size_t block = block_of(key);
  masks_[block] |= std::uint64_t{1} << bit_of(key);
  blocks_[block / 64] |= std::uint64_t{1} << block % 64;
  ++in_block_[block];
}

MapVoxel* VoxelHashMap::find_or_add(const VoxelKey& key) {
  const std::size_t slot = slot_of(key);
  if (numbers_[slot] != 0) return &voxels_[numbers_[slot] - 1];
  if (voxels_.full()) return nullptr;
  MapVoxel voxel;
  voxel.key = key;
  voxels_.push_back(voxel);
  index(voxels_.size() - 1, slot);
  count(key);
  return &voxels_.back();
}

/// In all blocks that hold the voxel or one beside it.
void VoxelHashMap::note(const VoxelKey& key, std::uint32_t sweep, std::uint32_t Changes::*change) {
  const int last_x = (key.x + 1) >> 2, last_y = (key.y + 1) >> 2, last_z = (key.z + 1) >> 2;
  for (int z = (key.z - 1) >> 2; z <= last_z; ++z) {
    for (int y = (key.y - 1) >> 2; y <= last_y; ++y) {
      for (int x = (key.x - 1) >> 2; x <= last_x; ++x) {
        changes_[BlockGrid::CellIndex{x, y, z}.slot()].*change = sweep;
      }
    }
  }
}

void VoxelHashMap::erase(std::size_t voxel, std::uint32_t sweep) {
  note(voxels_[voxel].key, sweep, &Changes::erased);
  const std::size_t block = block_of(voxels_[voxel].key);
  // A voxel of a block far off may stand behind the same bit, so it stays until all have gone.
  if (--in_block_[block] == 0) {
    masks_[block] = 0;
    blocks_[block / 64] &= ~(std::uint64_t{1} << block % 64);
  }
  // What follows in the same run of slots moves up, so that no search ends at the gap.
  std::size_t gap = voxels_[voxel].slot;
  for (std::size_t slot = (gap + 1) & mask_; numbers_[slot] != 0; slot = (slot + 1) & mask_) {
    const std::size_t other = numbers_[slot] - 1;
    const std::size_t home = home_slot(voxels_[other].key);
    if (((slot - home) & mask_) < ((slot - gap) & mask_)) continue;
    index(other, gap);
    gap = slot;
  }
  numbers_[gap] = 0;
  if (voxel + 1 != voxels_.size()) {
    voxels_[voxel] = voxels_.back();
    index(voxel, voxels_[voxel].slot);
  }
  voxels_.resize(voxels_.size() - 1);
}

void VoxelHashMap::shift(int dx, int dy, int dz, std::uint32_t sweep) {
  clear_index();
  changes_.assign(changes_.capacity(), {sweep, sweep});
  for (std::size_t i = 0; i < voxels_.size(); ++i) {
    VoxelKey& key = voxels_[i].key;
    key = key.shifted(dx, dy, dz);
    index(i, slot_of(key));
    count(key);
  }
}

}  // namespace scree
