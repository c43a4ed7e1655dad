#pragma once

#include "scree/core/fixed_vector.hpp"
#include "scree/core/obstacle.hpp"

namespace scree {

/// Where a hole's centre lies in a rock's box, takes out the less sure of the two: the hole is what
/// the rock hides, or the rock is the hole's far rim, unless it is much longer. The order stays.
void resolve_overlaps(FixedVector<Obstacle>& obstacles);

}  // namespace scree
