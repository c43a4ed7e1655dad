#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "scree/core/beam_count.hpp"
#include "scree/core/fixed_vector.hpp"
#include "scree/core/floor_to_cell.hpp"
#include "scree/terrain/toroidal_grid.hpp"

namespace scree {

/// A voxel's number along each axis, counted from the origin of its map.
/// @note 16 bits: voxels of 0.05 m reach 1638 m from the origin.
struct VoxelKey {
  std::int16_t x = 0, y = 0, z = 0;
  bool operator==(const VoxelKey&) const = default;

  /// Of the voxel that holds a place, given in voxels from the origin.
  static VoxelKey at(const Eigen::Vector3f& place) {
    return {static_cast<std::int16_t>(floor_to_cell(place.x())),
            static_cast<std::int16_t>(floor_to_cell(place.y())),
            static_cast<std::int16_t>(floor_to_cell(place.z()))};
  }
  VoxelKey shifted(int dx, int dy, int dz) const {
    return {static_cast<std::int16_t>(x + dx), static_cast<std::int16_t>(y + dy),
            static_cast<std::int16_t>(z + dz)};
  }
};

/// What the sweeps have seen in one voxel; a line of a processor's cache holds it.
struct alignas(64) MapVoxel {
  VoxelKey key;
  std::uint8_t hits = 0;           ///< points, saturating
  std::uint8_t isolated_hits = 0;  ///< how many of the hits ended alone, see RangeScatter
  std::uint8_t sweeps = 0;         ///< that hit it, saturating
  std::uint8_t misses = 0;         ///< beams that went through it since the last hit, saturating
  bool is_confirmed = false;       ///< what the last look at its neighbourhood found
  bool was_looked_at = false;      ///< its neighbourhood, for the cloud of the sweep before
  BeamCount beams;
  std::uint32_t last_sweep = 0;                         ///< number of the last sweep that hit it
  std::uint32_t seen_ds = 0;                            ///< end of that sweep, tenths of seconds
  std::uint32_t slot = 0;                               ///< kept by VoxelHashMap
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();       ///< of its points, the map's frame - origin
  Eigen::Vector3f seen_from = Eigen::Vector3f::Zero();  ///< at the last hit, the same frame
  float reflectivity = 0;

  bool is_isolated() const { return isolated_hits == hits; }
};
static_assert(sizeof(MapVoxel) == 64);

/// Voxels by their keys: a hash map of bounded memory with open addressing and linear probing. The
/// voxels stand one behind the other, so that all of them are visited quickly; erase() changes
/// their order.
class VoxelHashMap {
public:
  explicit VoxelHashMap(std::size_t capacity);

  void clear();
  std::size_t size() const { return voxels_.size(); }
  std::size_t capacity() const { return voxels_.capacity(); }
  MapVoxel& operator[](std::size_t index) { return voxels_[index]; }
  MapVoxel* begin() { return voxels_.begin(); }
  MapVoxel* end() { return voxels_.end(); }
  const MapVoxel* begin() const { return voxels_.begin(); }
  const MapVoxel* end() const { return voxels_.end(); }

  /// Null where there is none.
  const MapVoxel* find(const VoxelKey& key) const {
    if ((masks_[block_of(key)] >> bit_of(key) & 1) == 0) return nullptr;
    const std::uint32_t number = numbers_[slot_of(key)];
    return number == 0 ? nullptr : &voxels_[number - 1];
  }
  MapVoxel* find(const VoxelKey& key) {
    return const_cast<MapVoxel*>(std::as_const(*this).find(key));
  }
  /// Null when full.
  MapVoxel* find_or_add(const VoxelKey& key);
  /// Has the processor fetch what find_or_add() will read.
  void prefetch_index(const VoxelKey& key) const { __builtin_prefetch(&numbers_[home_slot(key)]); }
  void prefetch_voxel(const VoxelKey& key) const {
    const std::uint32_t number = numbers_[home_slot(key)];
    if (number != 0) __builtin_prefetch(&voxels_[number - 1]);
  }
  /// Removes a voxel; the last one takes its index.
  void erase(std::size_t index, std::uint32_t sweep);
  /// Notes that a voxel has become more in a sweep: what it tells of those around it.
  void grow(const VoxelKey& key, std::uint32_t sweep) { note(key, sweep, &Changes::grown); }
  /// The last sweeps in which a voxel, or one beside it, may have grown or been erased.
  struct Changes {
    std::uint32_t grown = 0, erased = 0;
  };
  const Changes& changes(const VoxelKey& key) const { return changes_[block_of(key)]; }
  /// Moves all keys. All may have changed in this sweep.
  void shift(int dx, int dy, int dz, std::uint32_t sweep);

  /// A block of 4 x 4 x 4 voxels: its number along each axis, counted from the origin.
  static constexpr int kBlockBits = 2;
  struct BlockKey {
    std::int32_t x = 0, y = 0, z = 0;
    bool operator==(const BlockKey&) const = default;

    static BlockKey of(const VoxelKey& key) {
      return {key.x >> kBlockBits, key.y >> kBlockBits, key.z >> kBlockBits};
    }
  };
  /// The voxels that there may be in a block, a bit each; 0: surely none. Most of a beam's way is
  /// empty, and is passed quickly by this.
  std::uint64_t voxels_in(const BlockKey& block) const {
    const std::size_t slot = slot_of(block);
    return (blocks_[slot / 64] >> (slot % 64) & 1) == 0 ? 0 : masks_[slot];
  }
  /// Whether there may be a voxel in a block with these voxels; false where it lies in another one.
  static bool may_hold(const BlockKey& block, std::uint64_t voxels, const VoxelKey& key) {
    return (voxels >> bit_of(key) & 1) != 0 && BlockKey::of(key) == block;
  }

private:
  /// Blocks that lie far apart share a count.
  using BlockGrid = ToroidalGrid<kGridAcross, kGridUp>;

  static std::size_t slot_of(const BlockKey& block) {
    return BlockGrid::CellIndex{block.x, block.y, block.z}.slot();
  }
  static std::size_t block_of(const VoxelKey& key) { return slot_of(BlockKey::of(key)); }
  /// The bit of a voxel in its block's mask.
  static unsigned bit_of(const VoxelKey& key) {
    return static_cast<unsigned>((key.x & 3) | (key.y & 3) << 2 | (key.z & 3) << 4);
  }
  std::size_t home_slot(const VoxelKey& key) const;
  /// The slot of a voxel, or the free one where it would stand.
  std::size_t slot_of(const VoxelKey& key) const {
    std::size_t slot = home_slot(key);
    while (numbers_[slot] != 0 && voxels_[numbers_[slot] - 1].key != key) slot = (slot + 1) & mask_;
    return slot;
  }
  void index(std::size_t voxel, std::size_t slot);
  void count(const VoxelKey& key);
  void note(const VoxelKey& key, std::uint32_t sweep, std::uint32_t Changes::*change);
  void clear_index();

  FixedVector<MapVoxel> voxels_;
  FixedVector<std::uint32_t> numbers_;  // by slot: the voxel's index plus one, 0 is free
  std::size_t mask_;
  FixedVector<std::uint64_t> masks_;     // of each block the voxels that there may be
  FixedVector<std::uint64_t> blocks_;    // those with any, a bit each: few enough for a cache
  FixedVector<std::uint16_t> in_block_;  // voxels, by block of 4 x 4 x 4
  FixedVector<Changes> changes_;         // by block
};

/// Sixteen voxels side by side have sixteen slots side by side: a line of a processor's cache.
inline std::size_t VoxelHashMap::home_slot(const VoxelKey& key) const {
  constexpr std::uint64_t kGoldenRatio = 0x9E3779B97F4A7C15U;  // Fibonacci hashing: 2^64 / phi
  const auto wide = [](int value) { return std::uint64_t{static_cast<std::uint16_t>(value)}; };
  const std::uint64_t word = wide(key.x >> 2) | wide(key.y >> 1) << 16U | wide(key.z >> 1) << 32U;
  const auto inside = static_cast<unsigned>((key.x & 3) | (key.y & 1) << 2 | (key.z & 1) << 3);
  return static_cast<std::size_t>((word * kGoldenRatio >> 32U) << 4U | inside) & mask_;
}

}  // namespace scree
