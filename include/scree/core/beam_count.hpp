#pragma once

#include <cstdint>

namespace scree {

/// What became of the beams that came to a place. Where they are many, both fade alike.
struct BeamCount {
  std::uint16_t ended = 0;   ///< there
  std::uint16_t passed = 0;  ///< through it, and ended farther on
};

}  // namespace scree
