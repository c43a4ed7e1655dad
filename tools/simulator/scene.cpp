#include "simulator/scene.hpp"

namespace scree {

TerrainSettings scene_terrain() {
  TerrainSettings settings;
  settings.size = 64;
  settings.placed_within = 14;
  settings.clear_radius = 1.5;
  settings.level_radius = 0.8;
  return settings;
}

LidarSettings scene_lidar() {
  LidarSettings lidar;
  lidar.translation = {0.10, 0.0, 0.95};
  lidar.rpy_deg = {0, 6, 0};
  return lidar;
}

}  // namespace scree
