#include "simulator/scene_counts.hpp"

#include "scree/core/random.hpp"

namespace scree {

EdgeCounts edges_of(Scene scene, std::uint64_t seed) {
  Random random(seed, 0x5CF);
  EdgeCounts edges;
  const auto add = [&](double chance, int& count) { count += random.chance(chance) ? 1 : 0; };
  switch (scene) {
    case Scene::cliff:
      edges.cliffs = 1;
      add(0.4, edges.cliffs);
      add(0.25, edges.banks);
      add(0.35, edges.ditches);
      add(0.1, edges.stairs);
      add(0.2, edges.ploughed);
      add(0.5, edges.pits);
      add(0.3, edges.pits);
      break;
    case Scene::kerb:
      edges.kerbs = 1;
      add(0.6, edges.kerbs);
      add(0.35, edges.stairs);
      add(0.25, edges.ditches);
      add(0.1, edges.cliffs);
      break;
    case Scene::street:
      add(0.8, edges.kerbs);
      add(0.5, edges.kerbs);
      add(0.15, edges.stairs);
      break;
    case Scene::quarry:
      add(0.3, edges.cliffs);
      add(0.4, edges.banks);
      add(0.2, edges.pits);
      add(0.6, edges.ruts);
      add(0.4, edges.ruts);
      break;
    default:
      break;
  }
  return edges;
}

PlantCounts plants_of(Scene scene, std::uint64_t seed) {
  Random random(seed, 0x5CD);
  PlantCounts plants;
  switch (scene) {
    case Scene::wood:
      plants.trees = random.uniform(0.015, 0.09);
      plants.bushes = random.uniform(0.01, 0.1);
      plants.tall_grass = random.uniform(0, 0.6);
      break;
    case Scene::meadow:
      plants.trees = random.uniform(0, 0.004);
      plants.bushes = random.uniform(0.004, 0.05);
      plants.hedges = static_cast<int>(random.index(4));
      plants.tall_grass = random.uniform(0.3, 0.85);
      break;
    default:
      break;
  }
  return plants;
}

StructureCounts structures_of(Scene scene, std::uint64_t seed) {
  Random random(seed, 0x5CC);
  const auto up_to = [&](std::size_t most) { return static_cast<int>(random.index(most + 1)); };
  StructureCounts structures;
  switch (scene) {
    case Scene::street:
      structures.facades = 1 + up_to(2);
      structures.fences = up_to(3);
      structures.cars = up_to(4);
      structures.poles = up_to(5);
      structures.booms = up_to(2);
      structures.debris = up_to(4);
      break;
    case Scene::quarry:
      structures.fences = up_to(1);
      structures.poles = up_to(2);
      structures.booms = 1 + up_to(4);
      structures.debris = 3 + up_to(12);
      break;
    case Scene::wood:
    case Scene::meadow:
      structures.fences = up_to(1);
      structures.booms = up_to(2);
      break;
    default:
      break;
  }
  return structures;
}

DiggingCounts diggings_of(Scene scene, std::uint64_t seed) {
  if (scene != Scene::quarry) return {};
  Random random(seed, 0x5CB);
  DiggingCounts diggings;
  diggings.rimmed_craters = 2 + static_cast<int>(random.index(7));
  diggings.ponds = static_cast<int>(random.index(3));
  return diggings;
}

}  // namespace scree
