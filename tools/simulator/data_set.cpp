#include "simulator/data_set.hpp"

namespace scree {
namespace {

void append(LabelledClusters& all, const LabelledClusters& part) {
  all.samples.insert(all.samples.end(), part.samples.begin(), part.samples.end());
  all.obstacles += part.obstacles;
  all.found += part.found;
}

/// More features than a walk would meet, so that fewer terrains are needed.
TerrainSettings crowded() {
  TerrainSettings settings;
  settings.positive = 18;
  settings.negative = 14;
  settings.smooth = 14;
  settings.placed_within = 19;
  return settings;
}

LabelledClusters from_cloud(Detector& detector, FixedVector<Obstacle>& unused, std::uint64_t seed) {
  const Terrain terrain(crowded(), seed);
  CloudSettings cloud;
  cloud.points = 600'000 + Random(seed).index(400'001);
  detector.detect(reconstructed_cloud(terrain, cloud, seed), unused);
  return label_clusters(detector, terrain, obstacle_ids(terrain));
}

}  // namespace

LabelledClusters make_data_set(Profile profile, const Settings& settings, SeedRange seeds,
                               const std::function<void(std::size_t)>& progress) {
  LabelledClusters all;
  Detector detector(settings.detect_cloud, Network());
  FixedVector<Obstacle> unused(static_cast<std::size_t>(settings.detect_cloud.max_obstacles));
  (void)profile;
  for (std::size_t i = 0; i < seeds.count; ++i) {
    append(all, from_cloud(detector, unused, seeds.first + i));
    progress(i + 1);
  }
  return all;
}

}  // namespace scree
