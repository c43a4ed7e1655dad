#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "scree/config/settings.hpp"
#include "simulator/terrain.hpp"

namespace scree {

/// The kinds of country that a simulated robot drives through.
enum class Scene : std::uint8_t {
  easy,      ///< nearly level and smooth
  rolling,   ///< slopes to 15 degrees, mounds and hollows
  rough,     ///< uneven by several centimetres, stones and dents
  crater,    ///< craters, pits and potholes, some inside hollows
  ditch,     ///< ditches, ledges and logs
  grass,     ///< tufts that light passes through
  mixed,     ///< some of all these
  cliff,     ///< cliffs, banks and ditches through the whole scene, wide pits
  kerb,      ///< level and smooth, with kerbs, stairs and drains
  wood,      ///< trees, bushes, uneven ground
  meadow,    ///< tall grass over metres, bushes, hedges
  boulders,  ///< a field or a slope of boulders that touch and overlap
  street,    ///< facades, walls, fences, kerbs, cars and poles on level ground
  quarry     ///< craters with rims, ponds, ruts, debris, booms, edges
};
inline constexpr std::array kScenes = {
    Scene::easy,   Scene::rolling,  Scene::rough,  Scene::crater, Scene::ditch,
    Scene::grass,  Scene::mixed,    Scene::cliff,  Scene::kerb,   Scene::wood,
    Scene::meadow, Scene::boulders, Scene::street, Scene::quarry};
std::string_view name_of(Scene scene);
std::optional<Scene> scene_named(std::string_view name);

/// Ground, and how many features of which shapes, for a scene whose features may stand on `area`
/// square metres. Size, placement and corridor are left as they are by default.
TerrainSettings scene_terrain(Scene scene, double area, std::uint64_t seed);

/// The whole terrain of one reconstructed cloud, 40 m across.
TerrainSettings cloud_terrain(Scene scene, std::uint64_t seed);

/// Terrain around a robot that stands at the origin: features within 10 m, a level clear spot.
TerrainSettings scene_terrain();

/// How the simulated robot carries its lidar: 0.95 m up, looking 6 degrees down.
LidarSettings scene_lidar();

}  // namespace scree
