#pragma once

namespace scree {

/// What became of the beams that came to a place; old ones count less.
struct BeamCount {
  float ended = 0;    ///< there
  float passed = 0;   ///< through it, and ended farther on
  float scatter = 0;  ///< sum over those that ended there, see RangeScatter; metres
};

}  // namespace scree
