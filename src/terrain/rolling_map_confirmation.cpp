#include "scree/terrain/rolling_map.hpp"

#include <array>
#include <cstddef>

// Which voxels of the map are ground or things on it, and which are noise or dust.
namespace scree {
namespace {

struct Offset {
  int x, y, z;
};

/// The voxels around one, those that share a face first: they are most often hit, too.
constexpr std::array<Offset, 26> kAround = [] {
  std::array<Offset, 26> around{};
  std::size_t count = 0;
  for (int axes = 1; axes <= 3; ++axes) {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          if (x * x + y * y + z * z == axes) around[count++] = {x, y, z};
        }
      }
    }
  }
  return around;
}();

}  // namespace

/// What is not confirmed stays so until a voxel around it grows. What is stays so until one of them
/// is erased, and is looked at every few sweeps only.
bool RollingMap::confirm(MapVoxel& voxel) const {
  constexpr std::uint32_t kLookEvery = 5;  // sweeps
  const VoxelHashMap::Changes& changes = voxels_.changes(voxel.key);
  const bool is_due = voxel.is_confirmed ? (sweep_ - voxel.last_sweep) % kLookEvery == 0 &&
                                               sweep_ - changes.erased <= kLookEvery
                                         : sweep_ - changes.grown <= 1;
  if (is_due || !voxel.was_looked_at) voxel.is_confirmed = has_confirmation(voxel);
  voxel.was_looked_at = true;
  return voxel.is_confirmed;
}

/// A voxel is confirmed by two sweeps that hit it, or by three that hit it or its neighbours.
/// Isolated hits need three sweeps in the voxel itself: grains of dust meet by chance.
bool RollingMap::has_confirmation(const MapVoxel& voxel) const {
  const auto is_hit_enough = [](const MapVoxel& each) {
    return each.sweeps > (each.is_isolated() ? 2 : 1);
  };
  if (is_hit_enough(voxel)) return true;
  if (voxel.is_isolated()) return false;
  std::uint32_t other_sweep = voxel.last_sweep;
  for (const Offset& offset : kAround) {
    const MapVoxel* const near = voxels_.find(voxel.key.shifted(offset.x, offset.y, offset.z));
    if (near == nullptr) continue;
    if (is_hit_enough(*near)) return true;
    if (near->is_isolated()) continue;
    if (near->last_sweep == voxel.last_sweep || near->last_sweep == other_sweep) continue;
    if (other_sweep != voxel.last_sweep) return true;
    other_sweep = near->last_sweep;
  }
  return false;
}

/// Few of the beams that come to dust end there, now here, now there, and it touches nothing solid,
/// as a blade's tip does. A voxel with many hits is no dust, whatever went past it.
bool RollingMap::is_dust(const MapVoxel& voxel) {
  constexpr std::uint16_t kSolidHits = 8;
  return voxel.hits < kSolidHits &&
         free_space_.is_nearly_empty(voxel.mean + origin_.cast<float>(), looks_);
}

}  // namespace scree
