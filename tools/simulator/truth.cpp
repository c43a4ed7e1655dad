#include "simulator/truth.hpp"

#include <string>

namespace scree {

std::vector<TrueObstacle> true_obstacles(const Terrain& terrain, std::span<const Mover> movers) {
  std::vector<TrueObstacle> obstacles;
  for (const TerrainFeature& feature : terrain.features()) {
    if (!feature.kind) continue;
    obstacles.push_back({feature.id, *feature.kind, feature.center, feature.footprint,
                         feature.height, std::string(feature.name)});
  }
  int id = static_cast<int>(terrain.features().size());
  for (const Mover& mover : movers) obstacles.push_back(true_obstacle(mover, ++id, terrain));
  return obstacles;
}

}  // namespace scree
