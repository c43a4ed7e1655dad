// The whole chain by both methods, and each of their stages, on a simulated cloud as large as the
// paper's.
#include <benchmark/benchmark.h>

#include <algorithm>

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
  for (auto _ : state) gradient().compute(cells, {}, slope_x, slope_y);
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
  GroundSurface surface(max_points(), limits().ground_cells);
  const PointCloud& points = ran().sloped().cells.points();
  for (auto _ : state) surface.build(points, ground_surface_of(ours));
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
