#include "scree/detect/surface_method.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scree/detect/cell.hpp"
#include "scree/detect/isolated_points.hpp"
#include "scree/detect/split_by_sign.hpp"

namespace scree {

namespace {

constexpr float kMostly = 0.7F;  // share of a cluster's points

/// The bounds of the points, and beyond them places where the ground may end, as far as a cloud
/// would tell of it.
PlaneBounds bounds_with_voids(const PointCloud& points, const SeenCloud& cloud) {
  PlaneBounds bounds = bounds_of(points);
  if (!cloud.robot || points.empty()) return bounds;
  constexpr float kDenseReach = 8;  // metres: farther off the lidar's rings leave gaps of their own
  const float reach = std::min(cloud.reach, kDenseReach);
  const Eigen::Vector2f low = cloud.robot->array() - reach, high = cloud.robot->array() + reach;
  const auto lower = [](float seen, float least) {
    return std::min(seen, std::max(seen - GroundEdges::kFarthest, least));
  };
  const auto higher = [](float seen, float most) {
    return std::max(seen, std::min(seen + GroundEdges::kFarthest, most));
  };
  bounds.low_x = lower(bounds.low_x, low.x());
  bounds.low_y = lower(bounds.low_y, low.y());
  bounds.high_x = higher(bounds.high_x, high.x());
  bounds.high_y = higher(bounds.high_y, high.y());
  return bounds;
}

}  // namespace

GroundSurfaceSettings ground_surface_of(const SurfaceSettings& settings) {
  return {.cell_size = static_cast<float>(settings.ground_cell),
          .cell_points = static_cast<float>(settings.ground_points),
          .finder = {.max_slope = static_cast<float>(settings.ground_slope),
                     .tolerance = static_cast<float>(settings.ground_tolerance),
                     .trend_reach = static_cast<float>(settings.ground_trend)}};
}

SurfaceMethod::SurfaceMethod(const SurfaceSettings& settings, double clearance,
                             const DetectorLimits& limits)
    : settings_(settings),
      highest_(clearance > 0 ? static_cast<float>(clearance)
                             : std::numeric_limits<float>::infinity()),
      max_candidates_(limits.candidates),
      kernel_(gradient_of(settings.kernel)),
      gradient_(limits.ground_cells),
      surface_(ground_surface_of(settings), limits.points, limits.ground_cells),
      beam_grid_(limits.ground_cells),
      height_(limits.points),
      roles_(limits.points),
      candidates_(limits.candidates),
      kept_(limits.candidates),
      euclidean_(limits.candidates),
      clusters_(limits.candidates, static_cast<std::size_t>(settings.min_cluster_size)),
      context_(limits.ground_cells),
      evidence_(limits.ground_cells),
      edges_(limits.ground_cells) {
  if (settings.clustering == SurfaceClustering::regions) {
    regions_.emplace(limits.candidates, limits.ground_cells);
  } else {
    split_ = PointCloud(limits.candidates);
  }
}

float SurfaceMethod::reach() const {
  const auto tolerance = static_cast<float>(settings_.cluster_tolerance);
  return reach_of_cells(EuclideanClusters::cell_size(tolerance), max_candidates_, 3);
}

ClusteredPoints SurfaceMethod::find(const PointCloud& points, const SeenCloud& cloud,
                                    StageCounts& counts, StageTimer& timer) {
  build_ground(points, cloud);
  mark_points_off_ground(points);
  thin_candidates(counts);
  timer.done(Stage::surface);
  gradient_.build(points, {roles_.data(), roles_.size()}, kernel_);
  gather_candidates(points, counts);
  timer.done(Stage::gradient);
  remove_isolated_points(candidates_,
                         kIsolationReach * static_cast<float>(settings_.cluster_tolerance),
                         euclidean_, kept_);
  timer.done(Stage::suppression);
  cluster(counts);
  const auto min_size = static_cast<std::uint32_t>(settings_.min_cluster_size);
  clusters_.part_bent(kept_, min_size);
  if (cloud.robot) clusters_.part_around(*cloud.robot, kept_.points, min_size);
  timer.done(Stage::clusters);
  measure_clusters(points);
  timer.done(Stage::features);
  return result();
}

void SurfaceMethod::build_ground(const PointCloud& points, const SeenCloud& cloud) {
  const auto lowest = static_cast<float>(settings_.body_height);
  if (cloud.beams.empty()) {
    surface_.build(points);
  } else {
    // What is loose, a rough surface tells.
    surface_.build_roughly(points, bounds_with_voids(points, cloud));
    beam_grid_.find_loose(cloud.points, cloud.beams, surface_, lowest, highest_);
    surface_.build_below(beam_grid_.loose());
  }
  beam_grid_.build(cloud.points, cloud.beams, surface_, lowest, highest_);
  evidence_.build(cloud, surface_);
  edges_.find(surface_, evidence_);
}

void SurfaceMethod::mark_points_off_ground(const PointCloud& points) {
  const auto least = static_cast<float>(settings_.body_height);
  height_.resize(points.size());
  roles_.resize(points.size());
  surface_.heights_above(points, height_);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t cell = surface_.cell_of(i);
    const bool is_low = std::abs(height_[i]) < least;
    // Among grass the ground is seen, and what stands on it.
    const bool is_ground = surface_.is_ground(cell) && !beam_grid_.is_loose(cell);
    // A rock that is narrower at the ground than above is no less steep for the ground seen below.
    const bool is_hidden = is_low && beam_grid_.stops_all(cell);
    roles_[i] = !is_low && !is_ground ? GradientRaster::Role::asks
                : is_hidden           ? GradientRaster::Role::left_out
                                      : GradientRaster::Role::counts;
  }
}

/// Where there is no room for all, those above the ground are thinned evenly: what stands there
/// loses points, and nothing is lost.
void SurfaceMethod::thin_candidates(StageCounts& counts) {
  std::size_t above = 0, below = 0;
  for (std::size_t i = 0; i < roles_.size(); ++i) {
    if (is_candidate(i)) ++(height_[i] > 0 ? above : below);
  }
  counts.candidates = above + below;
  if (above + below <= max_candidates_ || below >= max_candidates_) return;
  const std::size_t room = max_candidates_ - below;
  std::size_t due = 0;
  for (std::size_t i = 0; i < roles_.size(); ++i) {
    if (!is_candidate(i) || height_[i] <= 0) continue;
    due += room;
    if (due >= above) {
      due -= above;
    } else {
      roles_[i] = GradientRaster::Role::counts;
    }
  }
}

void SurfaceMethod::gather_candidates(const PointCloud& points, StageCounts& counts) {
  candidates_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_candidate(i)) continue;
    Slope slope = gradient_.at(points.x[i], points.y[i]);
    if (std::isnan(slope.x)) {
      slope = {0, 0};
    } else {
      ++counts.known;
    }
    if (!candidates_.push_back(points, i, slope.x, slope.y, height_[i])) {
      ++counts.candidates_dropped;
    }
  }
}

void SurfaceMethod::cluster(StageCounts& counts) {
  counts.kept = kept_.size();
  const auto tolerance = static_cast<float>(settings_.cluster_tolerance);
  const auto min_size = static_cast<std::uint32_t>(settings_.min_cluster_size);
  if (regions_) {
    regions_->label(kept_, surface_, beam_grid_, {tolerance, static_cast<float>(settings_.saddle)});
    clusters_.gather(kept_, regions_->labels(), regions_->sizes(), min_size);
  } else {
    split_by_sign(kept_, tolerance, split_);
    euclidean_.cluster(split_, tolerance);
    clusters_.gather(kept_, euclidean_.labels(), euclidean_.sizes(), min_size);
  }
  counts.clusters = clusters_.all().size();
}

void SurfaceMethod::measure_clusters(const PointCloud& points) {
  // Points below ground that is itself seen are reflections.
  constexpr float kMostBelowGround = 0.5F;
  context_.build(points, kept_, surface_);
  for (Cluster& cluster : clusters_.all()) {
    const auto members = clusters_.members(cluster);
    cluster.ground = surface_.height(cluster.box.center_x, cluster.box.center_y);
    cluster.features = measure(kept_, members);
    context_.measure(cluster, members, kept_, surface_, beam_grid_);
    cluster.is_terrace = is_terrace(cluster);
    const bool is_below = cluster.features[max_height] < 0;
    if (is_below && cluster.features[through_share] < kMostBelowGround) {
      // The ground all around a crater is known, or it would not be one.
      const bool is_of_ground = is_crater(cluster);
      cluster.evidence = is_of_ground ? Evidence::inside : evidence_.of(members, kept_, surface_);
      cluster.is_sure_hole = is_of_ground || is_open_pit(cluster);
    }
  }
}

/// Share of a cluster's points whose cells fulfil a condition.
template <class Condition>
float SurfaceMethod::share_of(const Cluster& cluster, const Condition& condition) const {
  const auto members = clusters_.members(cluster);
  const auto fulfilled = std::ranges::count_if(members, [&](std::uint32_t i) {
    return condition(surface_.cell_at(kept_.points.x[i], kept_.points.y[i]));
  });
  return static_cast<float>(fulfilled) / static_cast<float>(members.size());
}

/// Whether a cluster is ground on a higher level, whose edge alone is in the way.
bool SurfaceMethod::is_terrace(const Cluster& cluster) const {
  constexpr float kArea = 20;   // square metres: the roof of a car has a third of it
  constexpr float kHeight = 1;  // metres: lower than the roof of anything that drives
  const Features& features = cluster.features;
  if (features[min_height] < 0 || features[max_height] > kHeight) return false;
  return share_of(cluster, [&](std::size_t cell) { return surface_.patch_area(cell) >= kArea; }) >=
         kMostly;
}

/// Whether a cluster is a pit into which one sees, with ground all around: a cloud may come from
/// any place, and the network has not seen pits of all kinds from there. @pre evidence_ was asked
bool SurfaceMethod::is_open_pit(const Cluster& cluster) const {
  constexpr float kDeep = -0.3F;         // metres
  constexpr float kRim = 0.7F;           // with ground near it
  constexpr std::uint32_t kFewest = 60;  // points
  if (settings_.ground_trend > 0 || cluster.evidence != Evidence::inside) return false;
  return cluster.features[min_height] <= kDeep && evidence_.rim() >= kRim &&
         cluster.end - cluster.begin >= kFewest;
}

/// Whether a cluster is the whole of a crater, or its deepest part.
bool SurfaceMethod::is_crater(const Cluster& cluster) const {
  constexpr float kDeep = -0.2F;  // metres
  return cluster.features[min_height] <= kDeep &&
         share_of(cluster, [&](std::size_t cell) { return surface_.is_crater(cell); }) >= kMostly;
}

}  // namespace scree
