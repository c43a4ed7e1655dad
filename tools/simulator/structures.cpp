#include "simulator/structures.hpp"

#include "simulator/building.hpp"

namespace scree {
namespace {

enum StructureStream : std::uint64_t { kFacades = 1000, kFences, kCars, kPoles, kBooms, kDebris };

}  // namespace

std::vector<TerrainThing> draw_structures(const Terrain& terrain, FreeGround& ground,
                                          std::uint64_t seed) {
  const StructureCounts& counts = terrain.settings().structures;
  std::vector<TerrainThing> things;
  const auto add = [&](int count, Building::Draw draw, std::uint64_t stream) {
    Building(terrain, ground, Random(seed, stream)).build(count, draw, things);
  };
  add(counts.facades, &Building::facade, kFacades);
  add(counts.cars, &Building::car, kCars);
  add(counts.fences, &Building::fence, kFences);
  add(counts.booms, &Building::boom, kBooms);
  add(counts.poles, &Building::pole, kPoles);
  add(counts.debris, &Building::debris, kDebris);
  return things;
}

}  // namespace scree
