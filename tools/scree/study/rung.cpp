#include "study/rung.hpp"

#include <algorithm>
#include <cmath>

#include "scree/detect/cell.hpp"
#include "scree/detect/edge_method.hpp"
#include "scree/detect/isolated_points.hpp"
#include "scree/detect/label.hpp"
#include "scree/detect/split_by_sign.hpp"
#include "scree/detect/surface_method.hpp"

namespace scree::cli {

SurfaceRung::SurfaceRung(const DetectSettings& settings, const DetectorLimits& limits,
                         Candidates candidates)
    : settings_(settings),
      chosen_(candidates),
      gradient_(gradient_of(settings.edges.kernel)),
      voxel_grid_(limits.points),
      points_(limits.points),
      overhangs_(limits.ground_cells),
      sloped_(limits.points),
      surface_(ground_surface_of(settings.surface), limits.points, limits.ground_cells),
      beam_grid_(limits.ground_cells),
      candidates_(limits.candidates),
      kept_(limits.candidates),
      split_(limits.candidates),
      supervoxels_(limits.candidates),
      euclidean_(limits.candidates),
      labels_(limits.candidates),
      clusters_(limits.candidates),
      context_(limits.ground_cells) {}

ClusteredPoints SurfaceRung::find(PointView cloud) {
  take_in(cloud);
  sloped_.cells.build(points_, gradient_.reach());
  surface_.build(sloped_.points());
  // Nothing is known of the beams of a cloud, so all is solid.
  beam_grid_.build(cloud, {}, surface_, static_cast<float>(settings_.surface.body_height),
                   static_cast<float>(settings_.clearance));
  sloped_.compute(gradient_);
  gather_candidates();
  cluster();
  measure_clusters();
  return {kept_, clusters_};
}

void SurfaceRung::take_in(PointView cloud) {
  const auto leaf_size = static_cast<float>(settings_.leaf_size);
  voxel_grid_.filter(cloud, leaf_size, reach_of_cells(leaf_size, points_.capacity(), 3), points_);
  overhangs_.remove(points_, static_cast<float>(settings_.clearance));
}

void SurfaceRung::gather_candidates() {
  const PointCloud& points = sloped_.points();
  const auto threshold = static_cast<float>(settings_.edges.threshold);
  const auto least = static_cast<float>(settings_.surface.body_height);
  candidates_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float height = points.z[i] - surface_.height(points.x[i], points.y[i]);
    const bool is_ground = surface_.is_ground(surface_.cell_at(points.x[i], points.y[i]));
    const bool is_candidate = chosen_ == Candidates::steep
                                  ? sloped_.square_slope(i) >= threshold * threshold
                                  : std::abs(height) >= least && !is_ground;
    if (!is_candidate) continue;
    const bool is_known = sloped_.is_known(i);
    candidates_.push_back(points, i, is_known ? sloped_.slope_x[i] : 0.0F,
                          is_known ? sloped_.slope_y[i] : 0.0F, height);
  }
}

void SurfaceRung::cluster() {
  const EdgeSettings& edges = settings_.edges;
  const auto tolerance = static_cast<float>(edges.cluster_tolerance);
  if (chosen_ == Candidates::steep) {  // steep points do not float alone
    std::swap(candidates_, kept_);
  } else {
    remove_isolated_points(candidates_, kIsolationReach * tolerance, euclidean_, kept_);
  }
  const auto gap = static_cast<float>(2 * (edges.voxel_size + edges.seed_distance)) + tolerance;
  split_.clear();
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    split_.push_back(kept_.points, i, kept_.slope_x[i], kept_.slope_y[i], kept_.height[i]);
  }
  split_by_sign(kept_, gap, split_.points);
  supervoxels_.segment(split_, supervoxels_of(edges));
  supervoxels_.remove_small(static_cast<std::uint32_t>(edges.min_block_points));
  euclidean_.cluster(supervoxels_.centers(), tolerance);
  labels_.resize(kept_.size());
  std::ranges::transform(supervoxels_.labels(), labels_.begin(), [&](std::uint32_t block) {
    return block == kNoLabel ? kNoLabel : euclidean_.labels()[block];
  });
  clusters_.gather(kept_, labels_, euclidean_.sizes(),
                   static_cast<std::uint32_t>(edges.min_cluster_size));
}

void SurfaceRung::measure_clusters() {
  context_.build(points_, kept_, surface_);
  for (Cluster& cluster : clusters_.all()) {
    const auto members = clusters_.members(cluster);
    cluster.ground = surface_.height(cluster.box.center_x, cluster.box.center_y);
    cluster.features = measure(kept_, members);
    context_.measure(cluster, members, kept_, surface_, beam_grid_);
    cluster.evidence = Evidence::inside;  // a rung asks for none
  }
}

}  // namespace scree::cli
