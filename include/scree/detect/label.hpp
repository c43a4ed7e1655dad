#pragma once

#include <cstdint>

namespace scree {

/// What no super-voxel, region or cluster has taken.
inline constexpr std::uint32_t kNoLabel = UINT32_MAX;

}  // namespace scree
