#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "scree/terrain/voxel_hash_map.hpp"

namespace scree {

/// A walk along a beam through voxels, in steps as long as a voxel's edge.
class VoxelWalk {
public:
  /// @param from in voxels from the origin of the map
  /// @param along direction of the beam, of length one
  VoxelWalk(const Eigen::Vector3f& from, const Eigen::Vector3f& along)
      : from_(from), along_(along) {
    constexpr float kNever = 1e6F;  // steps a voxel, along an axis that the beam does not move on
    for (int axis = 0; axis < 3; ++axis) {
      steps_per_voxel_[axis] = along[axis] != 0 ? 1 / std::abs(along[axis]) : kNever;
    }
  }

  Eigen::Vector3f at(int step) const { return from_ + static_cast<float>(step) * along_; }

  /// How many more steps surely stay in the cube around a place.
  /// @param edge of the cube in voxels, a power of two
  int steps_within(int edge, const VoxelKey& key, const Eigen::Vector3f& place) const {
    constexpr float kRounding = 0.01F;  // steps
    const auto steps = [&](std::int16_t cell, int axis) {
      const auto low = static_cast<float>(cell & ~(edge - 1));
      const float left =
          along_[axis] > 0 ? low + static_cast<float>(edge) - place[axis] : place[axis] - low;
      return left * steps_per_voxel_[axis];
    };
    const float least = std::min({steps(key.x, 0), steps(key.y, 1), steps(key.z, 2)});
    return static_cast<int>(std::max(least - kRounding, 0.0F));
  }

private:
  Eigen::Vector3f from_, along_, steps_per_voxel_;
};

}  // namespace scree
