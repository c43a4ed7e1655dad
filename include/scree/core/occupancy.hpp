#pragma once

#include <cstdint>

namespace scree {

/// What is known of a point in space.
enum class Occupancy : std::uint8_t {
  unknown,  ///< no beam came there lately
  free,     ///< beams went through
  occupied  ///< beams ended there, or beside it
};

}  // namespace scree
