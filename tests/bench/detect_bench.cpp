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

std::size_t max_points() {
  return static_cast<std::size_t>(settings().max_points);
}
std::size_t max_edges() {
  return static_cast<std::size_t>(settings().max_edge_points);
}

const PointCloud& cloud() {
  static const PointCloud made =
      reconstructed_cloud(Terrain(TerrainSettings{}, 1), CloudSettings{}, 1);
  return made;
}

/// The detector after one call: each stage's input stands in it.
const Detector& ran() {
  static Detector detector(settings(), Network());
  static const bool once = [] {
    FixedVector<Obstacle> obstacles(1024);
    detector.detect(cloud(), obstacles);
    return true;
  }();
  static_cast<void>(once);
  return detector;
}

ElevationGradient gradient() {
  const auto& detect = settings();
  return {static_cast<float>(detect.kernel_spacing), static_cast<float>(detect.kernel_radius),
          static_cast<float>(detect.kernel_bandwidth * detect.kernel_radius),
          detect.kernel_neighbours};
}

void whole_chain(benchmark::State& state, const DetectSettings& method) {
  Detector detector(method, Network());
  FixedVector<Obstacle> obstacles(1024);
  const PointCloud& input = cloud();
  for (auto _ : state) detector.detect(input, obstacles);
  state.counters["points"] = static_cast<double>(input.size());
}
BENCHMARK_CAPTURE(whole_chain, paper, DetectSettings::for_paper())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(whole_chain, bodies, DetectSettings::for_cloud())->Unit(benchmark::kMillisecond);

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
  const PointCloud& thinned = ran().thinned();
  for (auto _ : state) cells.build(thinned, gradient().reach());
}
BENCHMARK(plane_cells)->Unit(benchmark::kMillisecond);

void elevation_gradient(benchmark::State& state) {
  const PlaneCells& cells = ran().cells();
  FixedVector<float> slope_x(max_points()), slope_y(max_points());
  slope_x.resize(cells.size());
  slope_y.resize(cells.size());
  for (auto _ : state) gradient().compute(cells, {}, slope_x, slope_y);
}
BENCHMARK(elevation_gradient)->Unit(benchmark::kMillisecond);

void suppression(benchmark::State& state) {
  const Suppression stage{static_cast<float>(settings().suppression_distance),
                          static_cast<float>(settings().suppression_radius)};
  PlaneCells cells(max_edges());
  EdgePoints kept(max_edges());
  const EdgePoints& edges = ran().edges();
  for (auto _ : state) stage.suppress(edges, cells, kept);
}
BENCHMARK(suppression)->Unit(benchmark::kMillisecond);

void supervoxels(benchmark::State& state) {
  Supervoxels stage(max_edges());
  const EdgePoints& kept = ran().kept();
  for (auto _ : state) {
    stage.segment(kept, {.voxel_size = static_cast<float>(settings().voxel_size),
                         .seed_distance = static_cast<float>(settings().seed_distance),
                         .reflectivity_weight = static_cast<float>(settings().reflectivity_weight),
                         .spatial_weight = static_cast<float>(settings().spatial_weight),
                         .normal_weight = static_cast<float>(settings().normal_weight)});
  }
}
BENCHMARK(supervoxels)->Unit(benchmark::kMillisecond);

void euclidean_baseline(benchmark::State& state) {
  EuclideanClusters stage(max_edges());
  const EdgePoints& kept = ran().kept();
  for (auto _ : state) stage.cluster(kept.points, 0.15F);
}
BENCHMARK(euclidean_baseline)->Unit(benchmark::kMillisecond);

void ground_surface(benchmark::State& state) {
  const DetectSettings ours = DetectSettings::for_cloud();
  GroundSurface surface(max_points(), static_cast<std::size_t>(ours.max_ground_cells));
  const PointCloud& points = ran().cells().points();
  for (auto _ : state) surface.build(points, surface_settings(ours));
}
BENCHMARK(ground_surface)->Unit(benchmark::kMillisecond);

void features_and_ground(benchmark::State& state) {
  const Detector& detector = ran();
  GroundHeight ground(static_cast<float>(settings().ground_inner),
                      static_cast<float>(settings().ground_outer), max_points());
  const std::vector<std::uint8_t> is_edge(detector.cells().size(), 0);
  const Clusters& clusters = detector.clusters();
  for (auto _ : state) {
    for (const Cluster& cluster : clusters.all()) {
      benchmark::DoNotOptimize(ground.around(cluster.box, detector.cells(), is_edge, 0));
      benchmark::DoNotOptimize(measure(detector.kept(), clusters.members(cluster)));
    }
  }
}
BENCHMARK(features_and_ground)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace scree
