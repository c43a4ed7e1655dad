#pragma once

#include "simulator/terrain_settings.hpp"

namespace scree::test {

/// Ground without obstacles.
/// @param size of the terrain, metres
inline TerrainSettings bare_terrain(double size) {
  TerrainSettings settings;
  settings.size = size;
  settings.positive = settings.negative = settings.smooth = 0;
  return settings;
}

/// The same as smooth as it can be, and level.
inline TerrainSettings level_terrain() {
  TerrainSettings settings = bare_terrain(24);
  settings.roughness = 0;
  settings.gentlest_slope_deg = settings.steepest_slope_deg = 0;
  return settings;
}

}  // namespace scree::test
