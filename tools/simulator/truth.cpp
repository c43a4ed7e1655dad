#include "simulator/truth.hpp"

#include <string>

namespace scree {

std::vector<TrueObstacle> true_obstacles(const Terrain& terrain) {
  std::vector<TrueObstacle> obstacles;
  for (const TerrainFeature& feature : terrain.features()) {
    if (!feature.kind) continue;
    obstacles.push_back({feature.id, *feature.kind, feature.center, feature.footprint,
                         feature.height, std::string(feature.name)});
  }
  return obstacles;
}

Result<void> write_truth(const std::filesystem::path& file, const Terrain& terrain, Truth truth) {
  truth.obstacles = true_obstacles(terrain);
  return write_truth(file, truth);
}

}  // namespace scree
