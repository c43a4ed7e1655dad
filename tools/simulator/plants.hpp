#pragma once

#include <cstdint>
#include <vector>

#include "simulator/placement.hpp"

namespace scree {

/// Trees, bushes and hedges of a terrain.
///
/// A tree is an obstacle: its trunk, and what of its crown hangs lower than 1.5 m. Bushes and
/// hedges are obstacles from 0.5 m of height on where at most 45 % of the light passes through
/// their middle; of lower or thinner ones a finding is neither asked for nor wrong.
std::vector<TerrainThing> draw_plants(const Terrain& terrain, FreeGround& ground,
                                      std::uint64_t seed);

/// Tall grass over metres, denser in some places; it leaves the robot's way free.
std::vector<Volume> grow_tall_grass(const Terrain& terrain, const FreeGround& ground,
                                    std::uint64_t seed);

}  // namespace scree
