#pragma once

#include <utility>
#include <variant>

#include "scree/config/settings.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/seen_cloud.hpp"
#include "scree/core/stage_times.hpp"
#include "scree/detect/edge_method.hpp"
#include "scree/detect/enclosing_polygon.hpp"
#include "scree/detect/network.hpp"
#include "scree/detect/overhangs.hpp"
#include "scree/detect/stage_counts.hpp"
#include "scree/detect/surface_method.hpp"
#include "scree/detect/voxel_grid.hpp"

namespace scree {

/// Finds obstacles in one point cloud: the points are taken in, clustered by the method that the
/// settings name, and classified by the network. Memory is taken once, here; detect() allocates
/// nothing, and gives the same result for the same cloud.
class Detector {
public:
  Detector(const DetectSettings& settings, const DetectorLimits& limits, Network network);

  /// Finds obstacles in a cloud in a gravity-aligned frame (z up) and writes them, numbered from 1,
  /// in that frame.
  /// @param timer started; takes the time of each stage
  void detect(const SeenCloud& cloud, FixedVector<Obstacle>& obstacles, StageTimer& timer);
  void detect(PointView cloud, FixedVector<Obstacle>& obstacles) {
    StageTimer none;
    detect({.points = cloud}, obstacles, none);
  }

  // Of the last call.
  const StageCounts& counts() const { return counts_; }
  /// The points that were taken in.
  const PointCloud& points() const { return points_; }
  /// Calls visit(const EdgeMethod&) or visit(const SurfaceMethod&).
  template <class Visit>
  decltype(auto) visit_method(Visit&& visit) const {
    return std::visit(std::forward<Visit>(visit), method_);
  }
  ClusteredPoints clustered() const {
    return visit_method([](const auto& method) { return method.result(); });
  }

  // Null where the method is another one.
  const EdgeMethod* edge_method() const { return std::get_if<EdgeMethod>(&method_); }
  const SurfaceMethod* surface_method() const { return std::get_if<SurfaceMethod>(&method_); }

private:
  using AnyMethod = std::variant<EdgeMethod, SurfaceMethod>;
  static AnyMethod make_method(const DetectSettings& settings, const DetectorLimits& limits);
  float common_reach() const;
  void take_in(PointView cloud);
  ClusteredPoints find_clusters(const SeenCloud& cloud, StageTimer& timer);

  float leaf_size_, clearance_;  // metres; 0: without
  double min_confidence_;
  Network network_;
  VoxelGrid voxel_grid_;
  PointCloud points_;
  Overhangs overhangs_;
  AnyMethod method_;
  EnclosingPolygons polygons_;
  float limit_;  // metres from the origin within which every stage's cells can be told apart
  StageCounts counts_;
};

}  // namespace scree
