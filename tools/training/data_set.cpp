#include "training/data_set.hpp"

#include <array>
#include <cmath>
#include <set>

#include "scoring/pose_error.hpp"
#include "scree/app/pipeline.hpp"
#include "simulator/drive.hpp"
#include "simulator/parallel.hpp"
#include "simulator/scene.hpp"
#include "training/worlds.hpp"

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
      : detector_(settings.detect_cloud, settings.memory.for_cloud(), Network()),
        unused_(static_cast<std::size_t>(settings.memory.obstacles)) {}

  LabelledClusters operator()(std::uint64_t seed) {
    const CloudWorld world(varied_terrain(seed), varied_cloud(seed), seed);
    detector_.detect(world.cloud, unused_);
    return label_clusters(detector_.clustered(), world.terrain.features(),
                          world.truth.visible[0].ids);
  }

private:
  Detector detector_;
  FixedVector<Obstacle> unused_;
};

class FromSweeps {
public:
  explicit FromSweeps(const Settings& settings)
      : lidar_(settings.lidar), pipeline_(by_themselves(settings), Networks()) {}

  LabelledClusters operator()(std::uint64_t seed) {
    constexpr std::array kRates = {5.0, 10.0, 10.0, 20.0};
    const SweepWorld world(lidar_, kRates[Random(seed).index(kRates.size())], seed);
    pipeline_.process(world.sweep);
    return label_clusters(pipeline_.detector().clustered(), world.terrain.features(),
                          world.truth.visible[0].ids);
  }

private:
  static Settings by_themselves(Settings settings) {
    settings.map.registration = false;
    return settings;
  }

  LidarSettings lidar_;
  Pipeline pipeline_;
};

/// The features where the pipeline believes them: what its pose is wrong by moves them too.
std::vector<TerrainFeature> as_believed(const std::vector<TerrainFeature>& features,
                                        const Pose& truth, const Pose& believed,
                                        const Eigen::Vector3d& origin) {
  const Pose to_believed = laid_onto(truth, believed);
  std::vector<TerrainFeature> moved = features;
  for (TerrainFeature& feature : moved) {
    for (Eigen::Vector2d& corner : feature.footprint) {
      corner = (to_believed * Eigen::Vector3d(corner.x(), corner.y(), 0) - origin).head<2>();
    }
  }
  return moved;
}

/// How a drive differs from others of its scene; never the terrain, which the seed gives.
struct DriveVariation {
  bool at_rest, registration;

  explicit DriveVariation(std::uint64_t seed) {
    constexpr std::uint64_t kStream = 0xD21F;
    Random random(seed, kStream);
    at_rest = random.chance(1.0 / 12);
    registration = !random.chance(1.0 / 8);
  }
};

CaptureSettings training_drive(std::uint64_t seed) {
  CaptureSettings drawn;
  drawn.seed = seed;
  drawn.scene = kScenes[seed % kScenes.size()];
  drawn.seconds = 10;
  drawn.at_rest = DriveVariation(seed).at_rest;
  return drawn;
}

class FromDrives {
public:
  explicit FromDrives(const Settings& settings) : settings_(settings) {}

  LabelledClusters operator()(std::uint64_t seed) {
    constexpr int kEvery = 5;  // sweeps
    constexpr double kLeastPiece = 0.25;
    const Drive drive(training_drive(seed));
    Settings settings = with_sensors_of(drive.robot, settings_);
    settings.map.registration = DriveVariation(seed).registration;
    Pipeline pipeline(settings, Networks());
    DriveFeed feed(drive);
    Sweep sweep(static_cast<std::size_t>(settings.memory.sweep_points));
    LabelledClusters all;
    for (int i = 1; feed.next(sweep, {&pipeline.sensors()}); ++i) {
      pipeline.process(sweep);
      if (i % kEvery != 0) continue;
      const Mapper& mapper = pipeline.mapper();
      const auto features = as_believed(drive.terrain.features(), drive.motion.base(sweep.end_ns),
                                        mapper.pose(), mapper.map().origin());
      all += label_clusters(pipeline.detector().clustered(), features,
                            feed.truth().visible.back().ids, kLeastPiece);
    }
    return all;
  }

private:
  Settings settings_;
};

class FromTracks {
public:
  FromTracks(const Settings& settings, const Network& clusters)
      : settings_(settings), clusters_(clusters) {}

  LabelledClusters operator()(std::uint64_t seed) {
    constexpr int kEvery = 3;  // sweeps
    const Drive drive(training_drive(seed));
    const Settings settings = with_sensors_of(drive.robot, settings_);
    Pipeline pipeline(settings, {clusters_, Network(), std::nullopt});
    DriveFeed feed(drive);
    Sweep sweep(static_cast<std::size_t>(settings.memory.sweep_points));
    std::set<int> known;
    LabelledClusters all;
    for (int i = 1; feed.next(sweep, {&pipeline.sensors()}); ++i) {
      pipeline.process(sweep);
      const std::vector<int>& asked = feed.truth().visible.back().ids;
      known.insert(asked.begin(), asked.end());
      if (i % kEvery != 0) continue;
      const Truth truth{
          feed.truth().obstacles, {{sweep.end_ns, drive.motion.base(sweep.end_ns)}}, {}};
      all += label_tracks(pipeline.tracker().tracks(), settings.track, pipeline.mapper().pose(),
                          sweep.end_ns, truth, known);
    }
    return all;
  }

private:
  Settings settings_;
  Network clusters_;
};

/// In the order of the seeds. @param arguments of the constructor of From
template <class From, class... Arguments>
LabelledClusters gather(SeedRange seeds, const std::function<void(std::size_t)>& progress,
                        const Arguments&... arguments) {
  std::vector<LabelledClusters> parts(seeds.count);
  const auto make_work = [&] {
    return
        [&, from = From(arguments...)](std::size_t i) mutable { parts[i] = from(seeds.first + i); };
  };
  in_parallel(seeds.count, make_work, progress);
  LabelledClusters all;
  for (const LabelledClusters& part : parts) all += part;
  return all;
}

}  // namespace

LabelledClusters make_data_set(Profile profile, const Settings& settings, SeedRange seeds,
                               const std::function<void(std::size_t)>& progress,
                               const Network& clusters) {
  switch (profile) {
    case Profile::cloud:
      return gather<FromClouds>(seeds, progress, settings);
    case Profile::map:
      return gather<FromDrives>(seeds, progress, settings);
    case Profile::track:
      return gather<FromTracks>(seeds, progress, settings, clusters);
    case Profile::sweep:
      break;
  }
  return gather<FromSweeps>(seeds, progress, settings);
}

}  // namespace scree
