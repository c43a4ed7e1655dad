#pragma once

#include <cstdint>

namespace scree {

/// floor() of a coordinate in cells, without the call that generic x86-64 makes of std::floor.
/// @pre |value| < 2^31
inline std::int32_t floor_to_cell(float value) {
  const auto truncated = static_cast<std::int32_t>(value);
  return truncated - (value < static_cast<float>(truncated) ? 1 : 0);
}

}  // namespace scree
