#pragma once

#include <cstdint>
#include <vector>

#include "simulator/placement.hpp"

namespace scree {

/// What people have built on a terrain or left there: facades with doors and windows, fences, cars,
/// poles, booms, and debris.
///
/// All are obstacles but for debris lower than 0.15 m, which is neither asked for nor wrong.
/// Windows return nothing. Booms and table tops hang 0.3-1.2 m above ground that is seen.
std::vector<TerrainThing> draw_structures(const Terrain& terrain, FreeGround& ground,
                                          std::uint64_t seed);

}  // namespace scree
