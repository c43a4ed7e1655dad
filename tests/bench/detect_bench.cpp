// The whole chain by both methods, and each of their stages, on a simulated cloud as large as the
// paper's.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <filesystem>

#include "bench/pcl_chain.hpp"
#include "scree/core/pcl_cloud.hpp"
#include "scree/detect/cell.hpp"
#include "scree/detect/detector.hpp"
#include "simulator/cloud.hpp"

namespace scree {
namespace {

const DetectSettings& settings() {
  static const DetectSettings defaults = DetectSettings::for_paper();
  return defaults;
}

DetectorLimits limits() {
  return MemorySettings().for_cloud();
}
std::size_t max_points() {
  return limits().points;
}
std::size_t max_edges() {
  return limits().candidates;
}

const PointCloud& cloud() {
  static const PointCloud made =
      reconstructed_cloud(Terrain(TerrainSettings{}, 1), CloudSettings{}, 1);
  return made;
}

const EdgeSettings& edge_settings() {
  return settings().edges;
}

/// The paper's detector after one call: each stage's input stands in it.
const Detector& ran_detector() {
  static Detector detector(settings(), limits(), Network());
  static const bool once = [] {
    FixedVector<Obstacle> obstacles(1024);
    detector.detect(cloud(), obstacles);
    return true;
  }();
  static_cast<void>(once);
  return detector;
}
const EdgeMethod& ran() {
  return *ran_detector().edge_method();
}

ElevationGradient gradient() {
  return gradient_of(edge_settings().kernel);
}

void whole_chain(benchmark::State& state, const DetectSettings& method) {
  Detector detector(method, limits(), Network());
  FixedVector<Obstacle> obstacles(1024);
  const PointCloud& input = cloud();
  for (auto _ : state) detector.detect(input, obstacles);
  state.counters["points"] = static_cast<double>(input.size());
}
BENCHMARK_CAPTURE(whole_chain, paper, DetectSettings::for_paper())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(whole_chain, surface, DetectSettings::for_cloud())->Unit(benchmark::kMillisecond);

/// The paper's method with plain Euclidean clustering: PCL has all that it needs.
DetectSettings plain_settings() {
  DetectSettings plain = DetectSettings::for_paper();
  plain.edges.clustering = EdgeClustering::euclidean;
  plain.edges.cluster_tolerance = 0.15;
  return plain;
}

Network paper_network() {
  Result<Network> network =
      Network::load(std::filesystem::path(SCREE_SOURCE) / "config" / settings().network);
  return network ? *network : Network();
}

/// How many of the obstacles have one of the same kind within 5 cm in the other list.
std::size_t agreeing(const FixedVector<Obstacle>& ours, const FixedVector<Obstacle>& theirs) {
  constexpr double kNear = 0.05;  // metres
  return static_cast<std::size_t>(std::ranges::count_if(ours, [&](const Obstacle& one) {
    return std::ranges::any_of(theirs, [&](const Obstacle& other) {
      return one.kind == other.kind && (one.center - other.center).norm() < kNear;
    });
  }));
}

void plain_chain(benchmark::State& state) {
  Detector detector(plain_settings(), limits(), paper_network());
  FixedVector<Obstacle> obstacles(1024);
  for (auto _ : state) detector.detect(cloud(), obstacles);
  state.counters["obstacles"] = static_cast<double>(obstacles.size());
}
BENCHMARK(plain_chain)->Unit(benchmark::kMillisecond);

void plain_chain_of_pcl(benchmark::State& state) {
  Detector detector(plain_settings(), limits(), paper_network());
  FixedVector<Obstacle> obstacles(1024), ours(1024);
  detector.detect(cloud(), ours);
  bench::PclChain chain(plain_settings(), max_points(), paper_network());
  const auto input = to_pcl(cloud());
  for (auto _ : state) chain.detect(input, obstacles);
  state.counters["obstacles"] = static_cast<double>(obstacles.size());
  state.counters["as_ours"] = static_cast<double>(agreeing(obstacles, ours));
}
BENCHMARK(plain_chain_of_pcl)->Unit(benchmark::kMillisecond);

/// How the time grows with the cloud.
void growth(benchmark::State& state) {
  CloudSettings settings;
  settings.points = static_cast<std::size_t>(state.range(0));
  const PointCloud input = reconstructed_cloud(Terrain(TerrainSettings{}, 1), settings, 1);
  Detector detector(DetectSettings::for_cloud(), limits(), Network());
  FixedVector<Obstacle> obstacles(1024);
  for (auto _ : state) detector.detect(input, obstacles);
}
BENCHMARK(growth)
    ->Unit(benchmark::kMillisecond)
    ->Arg(125'000)
    ->Arg(250'000)
    ->Arg(500'000)
    ->Arg(1'000'000);

void voxel_grid(benchmark::State& state) {
  VoxelGrid grid(max_points());
  PointCloud out(max_points());
  const auto leaf = static_cast<float>(settings().leaf_size);
  const PointCloud& input = cloud();
  for (auto _ : state) grid.filter(input, leaf, reach_of_cells(leaf, max_points(), 3), out);
}
BENCHMARK(voxel_grid)->Unit(benchmark::kMillisecond);

void plane_cells(benchmark::State& state) {
  PlaneCells cells(max_points());
  const PointCloud& thinned = ran_detector().points();
  for (auto _ : state) cells.build(thinned, gradient().reach());
}
BENCHMARK(plane_cells)->Unit(benchmark::kMillisecond);

void elevation_gradient(benchmark::State& state) {
  const PlaneCells& cells = ran().sloped().cells;
  FixedVector<float> slope_x(max_points()), slope_y(max_points());
  slope_x.resize(cells.size());
  slope_y.resize(cells.size());
  for (auto _ : state) gradient().compute(cells, slope_x, slope_y);
}
BENCHMARK(elevation_gradient)->Unit(benchmark::kMillisecond);

void suppression(benchmark::State& state) {
  const Suppression stage{static_cast<float>(edge_settings().suppression_distance),
                          static_cast<float>(edge_settings().suppression_radius)};
  PlaneCells cells(max_edges());
  CandidatePoints kept(max_edges());
  const CandidatePoints& edges = ran().candidates();
  for (auto _ : state) stage.suppress(edges, cells, kept);
}
BENCHMARK(suppression)->Unit(benchmark::kMillisecond);

void supervoxels(benchmark::State& state) {
  Supervoxels stage(max_edges());
  const CandidatePoints& kept = ran().result().points;
  for (auto _ : state) {
    stage.segment(kept, supervoxels_of(edge_settings()));
  }
}
BENCHMARK(supervoxels)->Unit(benchmark::kMillisecond);

template <class Stage>
void euclidean_clusters(benchmark::State& state) {
  Stage stage(max_edges());
  const CandidatePoints& kept = ran().result().points;
  for (auto _ : state) stage.cluster(kept.points, 0.15F);
}
BENCHMARK(euclidean_clusters<EuclideanClusters>)->Unit(benchmark::kMillisecond);
BENCHMARK(euclidean_clusters<KdTreeClusters>)->Unit(benchmark::kMillisecond);

void ground_surface(benchmark::State& state) {
  const SurfaceSettings ours = DetectSettings::for_cloud().surface;
  GroundSurface surface(ground_surface_of(ours), max_points(), limits().ground_cells);
  const PointCloud& points = ran().sloped().cells.points();
  for (auto _ : state) surface.build(points);
}
BENCHMARK(ground_surface)->Unit(benchmark::kMillisecond);

void features_and_ground(benchmark::State& state) {
  const PlaneCells& cells = ran().sloped().cells;
  const ClusteredPoints found = ran().result();
  GroundHeight ground(static_cast<float>(edge_settings().ground_inner),
                      static_cast<float>(edge_settings().ground_outer), max_points());
  const std::vector<std::uint8_t> is_edge(cells.size(), 0);
  for (auto _ : state) {
    for (const Cluster& cluster : found.clusters.all()) {
      benchmark::DoNotOptimize(ground.around(cluster.box, cells, is_edge, 0));
      benchmark::DoNotOptimize(measure(found.points, found.clusters.members(cluster)));
    }
  }
}
BENCHMARK(features_and_ground)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace scree
