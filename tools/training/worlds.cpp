#include "training/worlds.hpp"

#include "simulator/lidar.hpp"
#include "simulator/scene.hpp"
#include "simulator/truth.hpp"
#include "simulator/visibility.hpp"

namespace scree {
namespace {

CloudSettings of_points(std::size_t points) {
  CloudSettings settings;
  settings.points = points;
  return settings;
}

/// Shots of one turn, and of the packet in which it ends.
std::size_t shots_of_a_turn(double rate_hz) {
  return velodyne::kShots +
         static_cast<std::size_t>(velodyne::kLasers * 1e9 / (velodyne::kFiringNs * rate_hz));
}

}  // namespace

CloudWorld::CloudWorld(const TerrainSettings& ground, const CloudSettings& settings,
                       std::uint64_t seed)
    : terrain(ground, seed),
      cloud(reconstructed_cloud(terrain, settings, seed)),
      truth{true_obstacles(terrain),
            {{0, Pose()}},
            {{0, obstacle_ids(terrain), small_ids(terrain)}}} {}

CloudWorld::CloudWorld(const TerrainSettings& ground, std::size_t points, std::uint64_t seed)
    : CloudWorld(ground, of_points(points), seed) {}

TerrainSettings around_the_robot(std::uint64_t seed) {
  const TerrainSettings around = scene_terrain();
  TerrainSettings settings = scene_terrain(kScenes[seed % kScenes.size()],
                                           4 * around.placed_within * around.placed_within, seed);
  settings.placed_within = around.placed_within;
  settings.clear_radius = around.clear_radius;
  settings.level_radius = around.level_radius;
  settings.size = 2 * (settings.placed_within + 6);
  return settings;
}

SweepWorld::SweepWorld(const LidarSettings& lidar, double rate_hz, std::uint64_t seed)
    : terrain(around_the_robot(seed), seed), sweep(shots_of_a_turn(rate_hz)) {
  SimulatedLidarSettings settings;
  settings.model = lidar.model;
  settings.rate_hz = rate_hz;
  const RayCaster caster(terrain);
  SimulatedLidar turning(terrain, caster, settings, lidar.mount(), 0, seed);
  Visibility visibility(terrain);
  for (turning.advance(); turning.turns(turning.packet_end_ns()) <= 1; turning.advance()) {
    visibility.add(turning.shots());
    for (std::size_t i = 0; i < turning.shots().size(); ++i) {
      const SimulatedShot& shot = turning.shots()[i];
      if (shot.range <= 0) continue;
      const Eigen::Vector3f point = turning.point_of(i).cast<float>();
      sweep.points.push_back(point.x(), point.y(), point.z(), shot.reflectivity);
    }
  }
  visibility.end_sweep();
  truth = {true_obstacles(terrain), {{0, Pose()}}, {{0, visibility.seen(), visibility.not_seen()}}};
}

}  // namespace scree
