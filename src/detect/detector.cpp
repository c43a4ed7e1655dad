#include "scree/detect/detector.hpp"

#include <algorithm>

#include "scree/detect/cell.hpp"
#include "scree/detect/classification.hpp"

namespace scree {

Detector::Detector(const DetectSettings& settings, const DetectorLimits& limits, Network network)
    : leaf_size_(static_cast<float>(settings.leaf_size)),
      clearance_(static_cast<float>(settings.clearance)),
      min_confidence_(settings.min_confidence),
      network_(std::move(network)),
      voxel_grid_(leaf_size_ > 0 ? limits.points : 0),
      points_(limits.points),
      overhangs_(clearance_ > 0 ? limits.ground_cells : 0),
      method_(make_method(settings, limits)),
      polygons_(std::max(limits.candidates, limits.ground_cells)),
      limit_(common_reach()) {}

Detector::AnyMethod Detector::make_method(const DetectSettings& settings,
                                          const DetectorLimits& limits) {
  if (settings.method == Method::edges) return EdgeMethod(settings.edges, limits);
  return SurfaceMethod(settings.surface, settings.clearance, limits);
}

float Detector::common_reach() const {
  float reach = visit_method([](const auto& method) { return method.reach(); });
  const std::size_t points = points_.capacity();
  if (leaf_size_ > 0) reach = std::min(reach, reach_of_cells(leaf_size_, points, 3));
  return reach;
}

void Detector::detect(const SeenCloud& cloud, FixedVector<Obstacle>& obstacles, StageTimer& timer) {
  counts_ = {.input = cloud.points.size()};
  take_in(cloud.points);
  timer.done(Stage::voxel_grid);
  const ClusteredPoints found = find_clusters(cloud, timer);
  const Eigen::Vector2f robot = cloud.robot.value_or(Eigen::Vector2f::Zero());
  classify(found, network_, min_confidence_, robot, polygons_, obstacles, counts_);
  if (const auto* surface = std::get_if<SurfaceMethod>(&method_)) {
    add_edges(surface->edges(), robot, polygons_, obstacles, counts_);
  }
  std::int64_t id = 0;
  for (Obstacle& obstacle : obstacles) obstacle.id = ++id;
  timer.done(Stage::network);
}

void Detector::take_in(PointView cloud) {
  const Intake intake = leaf_size_ > 0 ? voxel_grid_.filter(cloud, leaf_size_, limit_, points_)
                                       : copy_finite(cloud, limit_, points_);
  counts_.dropped = intake.dropped;
  counts_.refused = intake.refused;
  counts_.voxels = points_.size();
  if (clearance_ > 0) overhangs_.remove(points_, clearance_);
  counts_.below_clearance = points_.size();
}

ClusteredPoints Detector::find_clusters(const SeenCloud& cloud, StageTimer& timer) {
  if (auto* edges = std::get_if<EdgeMethod>(&method_))
    return edges->find(points_, cloud, counts_, timer);
  return std::get<SurfaceMethod>(method_).find(points_, cloud, counts_, timer);
}

}  // namespace scree
