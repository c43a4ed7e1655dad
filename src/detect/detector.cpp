#include "scree/detect/detector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scree/detect/cell.hpp"

namespace scree {
namespace {

std::size_t count(int value) {
  return static_cast<std::size_t>(value);
}

/// Metres from the origin that every stage's cells reach.
float common_reach(const DetectSettings& settings, const ElevationGradient& gradient,
                   const Suppression& suppression) {
  const std::size_t points = count(settings.max_points), edges = count(settings.max_edge_points);
  return std::min(
      {reach_of_cells(static_cast<float>(settings.leaf_size), points, 3),
       reach_of_cells(PlaneCells::cell_size(Overhangs::kRadius), points, 2),
       reach_of_cells(PlaneCells::cell_size(gradient.reach()), points, 2),
       reach_of_cells(PlaneCells::cell_size(suppression.reach()), edges, 2),
       reach_of_cells(static_cast<float>(settings.voxel_size), edges, 3),
       reach_of_cells(static_cast<float>(settings.seed_distance), edges, 3),
       reach_of_cells(EuclideanClusters::cell_size(static_cast<float>(settings.cluster_tolerance)),
                      edges, 3)});
}

}  // namespace

GroundSurfaceSettings surface_settings(const DetectSettings& settings) {
  return {.cell_size = static_cast<float>(settings.ground_cell),
          .cell_points = static_cast<float>(settings.ground_points),
          .max_slope = static_cast<float>(settings.ground_slope),
          .tolerance = static_cast<float>(settings.ground_tolerance),
          .trend_reach = static_cast<float>(settings.ground_trend)};
}

Detector::Detector(const DetectSettings& settings, Network network)
    : settings_(settings),
      network_(std::move(network)),
      limit_(0),
      voxel_grid_(count(settings.max_points)),
      thinned_(count(settings.max_points)),
      overhangs_(count(settings.max_points)),
      gradient_{.spacing = static_cast<float>(settings.kernel_spacing),
                .radius = static_cast<float>(settings.kernel_radius),
                .bandwidth = static_cast<float>(settings.kernel_bandwidth * settings.kernel_radius),
                .min_neighbours = settings.kernel_neighbours,
                .shared_within = static_cast<float>(settings.kernel_shared)},
      cells_(count(settings.max_points)),
      slope_x_(count(settings.max_points)),
      slope_y_(count(settings.max_points)),
      height_(count(settings.max_points)),
      is_candidate_(count(settings.max_points)),
      is_edge_(count(settings.max_points)),
      edges_(count(settings.max_edge_points)),
      kept_(count(settings.max_edge_points)),
      parted_(count(settings.max_edge_points)),
      suppression_{.distance = static_cast<float>(settings.suppression_distance),
                   .radius = static_cast<float>(settings.suppression_radius)},
      edge_cells_(count(settings.max_edge_points)),
      supervoxels_(count(settings.max_edge_points)),
      euclidean_(count(settings.max_edge_points)),
      regions_(uses_regions() ? count(settings.max_edge_points) : 0,
               uses_regions() ? count(settings.max_ground_cells) : 0),
      labels_(count(settings.max_edge_points)),
      sizes_(count(settings.max_edge_points)),
      clusters_(count(settings.max_edge_points)),
      ground_(static_cast<float>(settings.ground_inner), static_cast<float>(settings.ground_outer),
              count(settings.max_points)),
      surface_(settings.uses_surface() ? count(settings.max_points) : 0,
               settings.uses_surface() ? count(settings.max_ground_cells) : 0),
      solidity_(settings.uses_surface() ? count(settings.max_ground_cells) : 0),
      surroundings_(settings.uses_surface() ? count(settings.max_ground_cells) : 0) {
  limit_ = common_reach(settings_, gradient_, suppression_);
}

void Detector::detect(PointView cloud, std::span<const BeamCount> beams,
                      FixedVector<Obstacle>& obstacles, StageTimer& timer) {
  counts_ = {.input = cloud.size()};
  thin(cloud);
  timer.done(Stage::voxel_grid);
  build_surface(cloud, beams);
  choose_candidates();
  timer.done(Stage::surface);
  find_edges();
  timer.done(Stage::gradient);
  thin_edges();
  timer.done(Stage::suppression);
  const EdgePoints& edges = parted();
  if (uses_supervoxels()) {
    grow_supervoxels(edges);
    timer.done(Stage::supervoxels);
  }
  find_clusters(edges);
  timer.done(Stage::clusters);
  measure_clusters();
  timer.done(Stage::features);
  recognise(obstacles);
  timer.done(Stage::network);
}

void Detector::thin(PointView cloud) {
  const Intake intake =
      settings_.voxel_grid
          ? voxel_grid_.filter(cloud, static_cast<float>(settings_.leaf_size), limit_, thinned_)
          : copy_finite(cloud, limit_, thinned_);
  counts_.dropped = intake.dropped;
  counts_.refused = intake.refused;
  counts_.voxels = thinned_.size();
  const auto clearance = static_cast<float>(settings_.clearance);
  if (clearance > 0) overhangs_.remove(thinned_, clearance);
  counts_.below_clearance = thinned_.size();
}

void Detector::build_surface(PointView cloud, std::span<const BeamCount> beams) {
  cells_.build(thinned_, gradient_.reach());
  if (!settings_.uses_surface()) return;
  const GroundSurfaceSettings ground = surface_settings(settings_);
  surface_.build(cells_.points(), ground);
  const float highest = settings_.clearance > 0 ? static_cast<float>(settings_.clearance)
                                                : std::numeric_limits<float>::infinity();
  const auto look_through = [&] {
    solidity_.build(cloud, beams, surface_, static_cast<float>(settings_.body_height), highest);
  };
  look_through();
  if (solidity_.has_loose()) {
    surface_.build_below(solidity_.loose(), ground);
    look_through();
  }
  if (!beams.empty()) leave_out_ground_below_edges();
}

/// A rock that is narrower at the ground than above is no less steep for the ground seen below it.
void Detector::leave_out_ground_below_edges() {
  const PointCloud& points = cells_.points();
  const auto highest = static_cast<float>(settings_.body_height);
  cells_.remove([&](std::size_t i) {
    const float x = points.x[i], y = points.y[i];
    return solidity_.stops_all(surface_.cell_at(x, y)) &&
           std::abs(points.z[i] - surface_.height(x, y)) < highest;
  });
}

void Detector::choose_candidates() {
  const PointCloud& points = cells_.points();
  is_candidate_.assign(points.size(), 1);
  height_.assign(points.size(), 0);
  if (!settings_.uses_surface()) return;
  const auto least = static_cast<float>(settings_.body_height);
  for (std::size_t i = 0; i < points.size(); ++i) {
    height_[i] = points.z[i] - surface_.height(points.x[i], points.y[i]);
    if (settings_.candidates == Candidates::edges) continue;
    const std::size_t cell = surface_.cell_at(points.x[i], points.y[i]);
    // Among grass the ground is seen, and what stands on it.
    const bool is_ground = surface_.is_ground(cell) && !solidity_.is_loose(cell);
    is_candidate_[i] = std::abs(height_[i]) >= least && !is_ground ? 1 : 0;
  }
}

void Detector::find_edges() {
  slope_x_.resize(cells_.size());
  slope_y_.resize(cells_.size());
  is_edge_.resize(cells_.size());
  gradient_.compute(cells_, is_candidate_, slope_x_, slope_y_);

  const bool takes_level_points = settings_.candidates == Candidates::bodies;
  const auto threshold = static_cast<float>(settings_.edge_threshold);
  edges_.clear();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const bool is_known = !std::isnan(slope_x_[i]);
    if (is_known) ++counts_.known;
    const float square = slope_x_[i] * slope_x_[i] + slope_y_[i] * slope_y_[i];
    is_edge_[i] = takes_level_points ? is_candidate_[i] : square >= threshold * threshold ? 1 : 0;
    if (is_edge_[i] == 0) continue;
    ++counts_.edges;
    if (!edges_.push_back(cells_.points(), i, is_known ? slope_x_[i] : 0.0F,
                          is_known ? slope_y_[i] : 0.0F, height_[i])) {
      ++counts_.edges_dropped;
    }
  }
}

void Detector::thin_edges() {
  if (settings_.suppression) {
    suppression_.suppress(edges_, edge_cells_, kept_);
  } else if (settings_.candidates == Candidates::bodies) {
    keep_company();
  }
}

/// Leaves out points that float alone: dust and wrong matches would stretch the body below them.
void Detector::keep_company() {
  constexpr float kReach = 1.5F;  // in units of the clusters' tolerance
  euclidean_.cluster(edges_.points, kReach * static_cast<float>(settings_.cluster_tolerance));
  count_members(euclidean_.labels(), euclidean_.count());
  kept_.clear();
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (sizes_[euclidean_.labels()[i]] < 2) continue;
    kept_.push_back(edges_.points, i, edges_.slope_x[i], edges_.slope_y[i], edges_.height[i]);
  }
}

/// With a gap opened between what stands above the ground and what lies below it, so that a hole
/// and the rock on its rim never grow together. Regions keep the two apart themselves.
const EdgePoints& Detector::parted() {
  if (!settings_.uses_surface() || uses_regions()) return kept();
  const auto gap = static_cast<float>(
      2 * (settings_.voxel_size + settings_.seed_distance + settings_.cluster_tolerance));
  parted_.clear();
  for (std::size_t i = 0; i < kept().size(); ++i) {
    const float height = kept().height[i];
    parted_.push_back(kept().points, i, kept().slope_x[i], kept().slope_y[i], height);
    parted_.points.z[i] = height > 0 ? gap : -gap;
  }
  return parted_;
}

void Detector::grow_supervoxels(const EdgePoints& edges) {
  supervoxels_.segment(edges,
                       {.voxel_size = static_cast<float>(settings_.voxel_size),
                        .seed_distance = static_cast<float>(settings_.seed_distance),
                        .reflectivity_weight = static_cast<float>(settings_.reflectivity_weight),
                        .spatial_weight = static_cast<float>(settings_.spatial_weight),
                        .normal_weight = static_cast<float>(settings_.normal_weight)});
  counts_.blocks = supervoxels_.blocks();
  supervoxels_.remove_small(static_cast<std::uint32_t>(settings_.min_block_points));
  counts_.blocks_kept = supervoxels_.blocks();
}

void Detector::find_clusters(const EdgePoints& edges) {
  const auto tolerance = static_cast<float>(settings_.cluster_tolerance);
  counts_.kept = edges.size();
  labels_.resize(edges.size());
  if (uses_supervoxels()) {
    euclidean_.cluster(supervoxels_.centers(), tolerance);
    std::ranges::transform(supervoxels_.labels(), labels_.begin(), [&](std::uint32_t block) {
      return block == kNoLabel ? kNoLabel : euclidean_.labels()[block];
    });
    count_members(euclidean_.labels(), euclidean_.count());
  } else if (uses_regions()) {
    regions_.label(edges, surface_, solidity_, {tolerance, static_cast<float>(settings_.saddle)});
    std::ranges::copy(regions_.labels(), labels_.begin());
    count_members(labels_, regions_.count());
  } else {
    euclidean_.cluster(edges.points, tolerance);
    std::ranges::copy(euclidean_.labels(), labels_.begin());
    count_members(labels_, euclidean_.count());
  }
  clusters_.gather(kept(), labels_, sizes_, static_cast<std::uint32_t>(settings_.min_cluster_size));
  counts_.clusters = clusters_.all().size();
}

/// Of each cluster: points or super-voxels.
void Detector::count_members(std::span<const std::uint32_t> labels, std::size_t clusters) {
  sizes_.assign(clusters, 0);
  for (const std::uint32_t label : labels) ++sizes_[label];
}

void Detector::measure_clusters() {
  EdgePoints& edges = thins_edges() ? kept_ : edges_;
  if (settings_.uses_surface()) {
    surroundings_.build(thinned_, edges, surface_);
  }
  for (Cluster& cluster : clusters_.all()) {
    const auto members = clusters_.members(cluster);
    if (settings_.ground == GroundReference::ring) {
      const float middle = (cluster.lowest + cluster.highest) / 2;
      cluster.ground = ground_.around(cluster.box, cells_, is_edge_, middle);
      for (const std::uint32_t i : members) edges.height[i] = edges.points.z[i] - cluster.ground;
    } else {
      cluster.ground = surface_.height(cluster.box.center_x, cluster.box.center_y);
    }
    cluster.features = measure(edges, members);
    if (settings_.uses_surface()) {
      surroundings_.measure(cluster, members, edges, surface_, solidity_);
    }
  }
}

void Detector::recognise(FixedVector<Obstacle>& obstacles) {
  obstacles.clear();
  for (const Cluster& cluster : clusters_.all()) {
    const Answer answer = network_(cluster.features);
    if (answer.confidence() < static_cast<float>(settings_.min_confidence)) continue;
    const bool is_positive = answer.kind() == ObstacleKind::positive;
    const float height = cluster.features[is_positive ? max_height : min_height];
    // A rock below the ground or a hole above it is the network's error, not an obstacle.
    if (is_positive ? height <= 0 : height >= 0) continue;
    ++counts_.obstacles;
    const float low = std::min(cluster.lowest, cluster.ground);
    const float high = std::max(cluster.highest, cluster.ground);
    Obstacle obstacle;
    obstacle.id = static_cast<std::int64_t>(obstacles.size()) + 1;
    obstacle.kind = answer.kind();
    obstacle.confidence = answer.confidence();
    obstacle.center = {cluster.box.center_x, cluster.box.center_y, (low + high) / 2};
    obstacle.extent = {cluster.box.length, cluster.box.width, high - low};
    obstacle.yaw = cluster.box.yaw;
    obstacle.height = height;
    obstacle.points = cluster.end - cluster.begin;
    if (!obstacles.push_back(obstacle)) ++counts_.obstacles_dropped;
  }
}

}  // namespace scree
