#include "simulator/data_set.hpp"

#include <array>
#include <cmath>

#include "scree/app/pipeline.hpp"
#include "simulator/scene.hpp"
#include "simulator/worlds.hpp"

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

class FromClouds {
public:
  explicit FromClouds(const Settings& settings)
      : detector_(settings.detect_cloud, Network()),
        unused_(static_cast<std::size_t>(settings.detect_cloud.max_obstacles)) {}

  LabelledClusters operator()(std::uint64_t seed) {
    const CloudWorld world(varied_terrain(seed), varied_cloud(seed), seed);
    detector_.detect(world.cloud, unused_);
    return label_clusters(detector_, world.terrain.features(), world.truth.visible[0].ids);
  }

private:
  Detector detector_;
  FixedVector<Obstacle> unused_;
};

class FromSweeps {
public:
  explicit FromSweeps(const Settings& settings)
      : lidar_(settings.lidar), pipeline_(settings, Detector(settings.detect_sweep, Network())) {}

  LabelledClusters operator()(std::uint64_t seed) {
    constexpr std::array kRates = {5.0, 10.0, 10.0, 20.0};
    const SweepWorld world(lidar_, kRates[Random(seed).index(kRates.size())], seed);
    pipeline_.process(world.sweep);
    return label_clusters(pipeline_.detector(), world.terrain.features(),
                          world.truth.visible[0].ids);
  }

private:
  LidarSettings lidar_;
  Pipeline pipeline_;
};

template <class From>
LabelledClusters gather(From from, SeedRange seeds,
                        const std::function<void(std::size_t)>& progress) {
  LabelledClusters all;
  for (std::size_t i = 0; i < seeds.count; ++i) {
    all += from(seeds.first + i);
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
