#pragma once

#include "scree/config/settings.hpp"
#include "simulator/terrain.hpp"

namespace scree {

/// Terrain around a robot that stands at the origin: features within 14 m, a level clear spot.
TerrainSettings scene_terrain();

/// How the simulated robot carries its lidar: 0.95 m up, looking 6 degrees down.
LidarSettings scene_lidar();

}  // namespace scree
