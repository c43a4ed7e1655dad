#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "scree/core/floor_to_cell.hpp"
#include "scree/terrain/voxel_hash_map.hpp"

namespace scree {

/// A walk along a beam through voxels, in steps as long as a voxel's edge.
class VoxelWalk {
public:
  /// @param from in voxels from the origin of the map
  /// @param along direction of the beam, of length one
  VoxelWalk(const Eigen::Vector3f& from, const Eigen::Vector3f& along)
      : from_(from), along_(along) {}

  Eigen::Vector3f at(int step) const { return from_ + static_cast<float>(step) * along_; }

  /// Calls visit(step, key) at the steps, from 0 on, at which a map may have a voxel. The beam is
  /// followed from block to block, from border to border (Amanatides and Woo, A fast voxel
  /// traversal algorithm for ray tracing, Eurographics 1987); steps are taken in blocks that hold
  /// something.
  template <class Visit>
  void for_each_voxel(const VoxelHashMap& map, int steps, Visit&& visit) const {
    constexpr float kRounding = 0.01F;  // steps
    Axis x(from_.x(), along_.x()), y(from_.y(), along_.y()), z(from_.z(), along_.z());
    const auto end = static_cast<float>(steps);
    float enter = 0;
    while (enter < end) {
      const VoxelHashMap::BlockKey block{x.block, y.block, z.block};
      const float leave = std::min({x.leave, y.leave, z.leave});
      if (const std::uint64_t voxels = map.voxels_in(block); voxels != 0) {
        const int last = static_cast<int>(std::min(leave + kRounding, end - 1));
        for (int step = static_cast<int>(std::ceil(std::max(enter - kRounding, 0.0F)));
             step <= last; ++step) {
          const VoxelKey key = VoxelKey::at(at(step));
          if (VoxelHashMap::may_hold(block, voxels, key)) visit(step, key);
        }
      }
      x.pass(leave);
      y.pass(leave);
      z.pass(leave);
      enter = leave;
    }
  }

private:
  /// Where the beam is along one axis of the blocks.
  struct Axis {
    std::int32_t block;  ///< its number
    std::int32_t next;   ///< to the next one: 1 or -1
    float leave;         ///< steps from the beginning to where it is left
    float across;        ///< steps from one to the next

    Axis(float from, float along)
        : block(floor_to_cell(from) >> VoxelHashMap::kBlockBits), next(along > 0 ? 1 : -1) {
      constexpr float kNever = 1e9F;  // steps, where the beam does not move along the axis
      constexpr int kEdge = 1 << VoxelHashMap::kBlockBits;
      const auto border = static_cast<float>((block + (along > 0 ? 1 : 0)) * kEdge);
      leave = along != 0 ? (border - from) / along : kNever;
      across = along != 0 ? static_cast<float>(kEdge) / std::abs(along) : kNever;
    }
    void pass(float at) {
      const bool is_left = leave == at;
      block += is_left ? next : 0;
      leave += is_left ? across : 0;
    }
  };

  Eigen::Vector3f from_, along_;
};

}  // namespace scree
