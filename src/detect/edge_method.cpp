#include "scree/detect/edge_method.hpp"

#include <algorithm>
#include <utility>

#include "scree/detect/cell.hpp"
#include "scree/detect/label.hpp"

namespace scree {
namespace {

std::optional<Suppression> suppression_of(const EdgeSettings& settings) {
  if (!settings.suppression) return std::nullopt;
  return Suppression{.distance = static_cast<float>(settings.suppression_distance),
                     .radius = static_cast<float>(settings.suppression_radius)};
}

}  // namespace

SupervoxelSettings supervoxels_of(const EdgeSettings& settings) {
  return {.voxel_size = static_cast<float>(settings.voxel_size),
          .seed_distance = static_cast<float>(settings.seed_distance),
          .reflectivity_weight = static_cast<float>(settings.reflectivity_weight),
          .spatial_weight = static_cast<float>(settings.spatial_weight),
          .normal_weight = static_cast<float>(settings.normal_weight)};
}

EdgeMethod::EdgeMethod(const EdgeSettings& settings, const DetectorLimits& limits)
    : settings_(settings),
      max_points_(limits.points),
      max_edges_(limits.candidates),
      gradient_(gradient_of(settings.kernel)),
      suppression_(suppression_of(settings)),
      sloped_(limits.points),
      is_edge_(limits.points),
      edges_(limits.candidates),
      kept_(suppression_ ? limits.candidates : 0),
      edge_cells_(suppression_ ? limits.candidates : 0),
      euclidean_(limits.candidates),
      labels_(limits.candidates),
      clusters_(limits.candidates, static_cast<std::size_t>(settings.min_cluster_size)),
      ground_(static_cast<float>(settings.ground_inner), static_cast<float>(settings.ground_outer),
              limits.points),
      sectors_(limits.points) {
  if (settings.clustering == EdgeClustering::supervoxel) supervoxels_.emplace(limits.candidates);
}

float EdgeMethod::reach() const {
  float reach = reach_of_cells(PlaneCells::cell_size(gradient_.reach()), max_points_, 2);
  const auto include = [&](float cell_size, int axes) {
    reach = std::min(reach, reach_of_cells(cell_size, max_edges_, axes));
  };
  if (suppression_) include(PlaneCells::cell_size(suppression_->reach()), 2);
  if (supervoxels_) {
    include(static_cast<float>(settings_.voxel_size), 3);
    include(static_cast<float>(settings_.seed_distance), 3);
  }
  return reach;
}

ClusteredPoints EdgeMethod::find(const PointCloud& points, const SeenCloud& cloud,
                                 StageCounts& counts, StageTimer& timer) {
  sloped_.cells.build(points, gradient_.reach());
  sloped_.compute(gradient_);
  select_edges(counts);
  timer.done(Stage::gradient);
  if (suppression_) suppression_->suppress(edges_, edge_cells_, kept_);
  timer.done(Stage::suppression);
  CandidatePoints& edges = suppression_ ? kept_ : edges_;
  cluster(edges, counts, timer);
  if (cloud.robot) {
    clusters_.part_around(*cloud.robot, edges.points,
                          static_cast<std::uint32_t>(settings_.min_cluster_size));
  }
  timer.done(Stage::clusters);
  const bool knows_beams = !cloud.origins.empty();
  if (knows_beams) sectors_.build(points, cloud.origins.front());
  measure_clusters(edges, knows_beams);
  timer.done(Stage::features);
  return result();
}

void EdgeMethod::select_edges(StageCounts& counts) {
  const auto threshold = static_cast<float>(settings_.threshold);
  is_edge_.resize(sloped_.size());
  edges_.clear();
  for (std::size_t i = 0; i < sloped_.size(); ++i) {
    if (sloped_.is_known(i)) ++counts.known;
    is_edge_[i] = sloped_.square_slope(i) >= threshold * threshold ? 1 : 0;
    if (is_edge_[i] == 0) continue;
    ++counts.candidates;
    if (!edges_.push_back(sloped_.points(), i, sloped_.slope_x[i], sloped_.slope_y[i])) {
      ++counts.candidates_dropped;
    }
  }
}

void EdgeMethod::cluster(const CandidatePoints& edges, StageCounts& counts, StageTimer& timer) {
  counts.kept = edges.size();
  const auto tolerance = static_cast<float>(settings_.cluster_tolerance);
  labels_.resize(edges.size());
  if (supervoxels_) {
    grow_supervoxels(edges, counts);
    timer.done(Stage::supervoxels);
    euclidean_.cluster(supervoxels_->centers(), tolerance);
    std::ranges::transform(supervoxels_->labels(), labels_.begin(), [&](std::uint32_t block) {
      return block == kNoLabel ? kNoLabel : euclidean_.labels()[block];
    });
  } else {
    euclidean_.cluster(edges.points, tolerance);
    std::ranges::copy(euclidean_.labels(), labels_.begin());
  }
  clusters_.gather(edges, labels_, euclidean_.sizes(),
                   static_cast<std::uint32_t>(settings_.min_cluster_size));
  counts.clusters = clusters_.all().size();
}

void EdgeMethod::grow_supervoxels(const CandidatePoints& edges, StageCounts& counts) {
  supervoxels_->segment(edges, supervoxels_of(settings_));
  counts.blocks = supervoxels_->blocks();
  supervoxels_->remove_small(static_cast<std::uint32_t>(settings_.min_block_points));
  counts.blocks_kept = supervoxels_->blocks();
}

void EdgeMethod::measure_clusters(CandidatePoints& edges, bool knows_beams) {
  for (Cluster& cluster : clusters_.all()) {
    const auto members = clusters_.members(cluster);
    const float middle = (cluster.lowest + cluster.highest) / 2;
    cluster.ground = ground_.around(cluster.box, sloped_.cells, is_edge_, middle);
    for (const std::uint32_t i : members) edges.height[i] = edges.points.z[i] - cluster.ground;
    cluster.features = measure(edges, members);
    cluster.evidence =
        knows_beams ? sectors_.of(members, edges.points, cluster.ground) : Evidence::inside;
  }
}

}  // namespace scree
