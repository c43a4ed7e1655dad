#include "simulator/data_set.hpp"

#include <array>
#include <cmath>

#include "scree/app/pipeline.hpp"
#include "simulator/lidar.hpp"
#include "simulator/scene.hpp"
#include "simulator/visibility.hpp"

namespace scree {

TerrainSettings varied_terrain(std::uint64_t seed) {
  const std::uint64_t turn = seed % (kScenes.size() + 1);
  if (turn < kScenes.size()) return cloud_terrain(kScenes[turn], seed);
  TerrainSettings settings;
  settings.positive = 18;
  settings.negative = 14;
  settings.smooth = 24;
  settings.placed_within = 19;
  return settings;
}

CloudSettings varied_cloud(std::uint64_t seed) {
  constexpr std::uint64_t kStream = 0x7EA1;
  Random random(seed, kStream);
  CloudSettings cloud;
  cloud.points = 250'000 + random.index(750'001);
  cloud.noise = random.uniform(0.004, 0.018);
  cloud.scattered_share = random.uniform(0, 0.001);
  cloud.density_spread = random.uniform(1, 4);
  if (random.chance(0.4)) cloud.rim_density = std::exp(random.uniform(-7, 0));
  cloud.wall_density = random.uniform(0.2, 1);
  cloud.ghosting = random.uniform(0, 0.015);
  return cloud;
}

namespace {

void append(LabelledClusters& all, const LabelledClusters& part) {
  all.samples.insert(all.samples.end(), part.samples.begin(), part.samples.end());
  all.obstacles += part.obstacles;
  all.found += part.found;
}

class FromClouds {
public:
  explicit FromClouds(const Settings& settings)
      : detector_(settings.detect_cloud, Network()),
        unused_(static_cast<std::size_t>(settings.detect_cloud.max_obstacles)) {}

  LabelledClusters operator()(std::uint64_t seed) {
    const Terrain terrain(varied_terrain(seed), seed);
    detector_.detect(reconstructed_cloud(terrain, varied_cloud(seed), seed), unused_);
    return label_clusters(detector_, terrain.features(), obstacle_ids(terrain));
  }

private:
  Detector detector_;
  FixedVector<Obstacle> unused_;
};

/// The scenes in turn, with the robot at rest in their middle.
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

class FromSweeps {
public:
  explicit FromSweeps(const Settings& settings)
      : mount_(settings.lidar.mount()),
        pipeline_(settings, Detector(settings.detect_sweep, Network())),
        sweep_(static_cast<std::size_t>(settings.detect_sweep.max_points)) {
    lidar_.model = settings.lidar.model;
  }

  LabelledClusters operator()(std::uint64_t seed) {
    constexpr std::array kRates = {5.0, 10.0, 10.0, 20.0};
    lidar_.rate_hz = kRates[Random(seed).index(kRates.size())];
    const Terrain terrain(around_the_robot(seed), seed);
    const RayCaster caster(terrain);
    SimulatedLidar lidar(terrain, caster, lidar_, mount_, 0, seed);
    Visibility visibility(terrain);
    sweep_.clear();
    for (lidar.advance(); lidar.turns(lidar.packet_end_ns()) <= 1; lidar.advance()) {
      visibility.add(lidar.shots());
      for (std::size_t i = 0; i < lidar.shots().size(); ++i) {
        const SimulatedShot& shot = lidar.shots()[i];
        if (shot.range <= 0) continue;
        const Eigen::Vector3f point = lidar.point_of(i).cast<float>();
        sweep_.points.push_back(point.x(), point.y(), point.z(), shot.reflectivity);
      }
    }
    visibility.end_sweep();
    pipeline_.process(sweep_);
    return label_clusters(pipeline_.detector(), terrain.features(), visibility.seen());
  }

private:
  SimulatedLidarSettings lidar_;
  Pose mount_;
  Pipeline pipeline_;
  Sweep sweep_;
};

template <class From>
LabelledClusters gather(From from, SeedRange seeds,
                        const std::function<void(std::size_t)>& progress) {
  LabelledClusters all;
  for (std::size_t i = 0; i < seeds.count; ++i) {
    append(all, from(seeds.first + i));
    progress(i + 1);
  }
  return all;
}

}  // namespace

LabelledClusters make_data_set(Profile profile, const Settings& settings, SeedRange seeds,
                               const std::function<void(std::size_t)>& progress) {
  return profile == Profile::cloud ? gather(FromClouds(settings), seeds, progress)
                                   : gather(FromSweeps(settings), seeds, progress);
}

}  // namespace scree
