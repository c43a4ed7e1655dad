#pragma once

#include <cstdint>

#include "simulator/scene.hpp"
#include "simulator/terrain_settings.hpp"

namespace scree {

/// What a scene has beside rocks, holes and tufts; drawn anew for each seed.
EdgeCounts edges_of(Scene scene, std::uint64_t seed);
PlantCounts plants_of(Scene scene, std::uint64_t seed);
StructureCounts structures_of(Scene scene, std::uint64_t seed);
DiggingCounts diggings_of(Scene scene, std::uint64_t seed);

}  // namespace scree
