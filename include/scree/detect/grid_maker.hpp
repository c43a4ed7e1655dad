#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "scree/core/obstacle.hpp"
#include "scree/core/obstacle_grid.hpp"
#include "scree/core/pose.hpp"
#include "scree/detect/ground_surface.hpp"

namespace scree {

struct GridSettings {
  double cell_size;   ///< metres
  double reach;       ///< from the robot to each side, metres; ObstacleGrid has a most of cells
  float body_height;  ///< what is seen this far above or below the surface is no ground, metres
};

/// Tells for each cell around the robot whether it is free, occupied, a drop or unknown. Free is
/// only what was seen: at least half of a cell lies in cells of the surface that are ground, and no
/// point in them stands off it. What was spanned is not free, nor what stands there unpublished.
class GridMaker {
public:
  explicit GridMaker(const GridSettings& settings) : settings_(settings) {}

  /// @param surface_in_odom the surface's frame in `odom`, upright but for a small lean
  /// @param list what is published with it, in `odom`
  const ObstacleGrid& make(const GroundSurface& surface, const Pose& surface_in_odom,
                           const ObstacleList& list);

private:
  void lay_out(const ObstacleList& list);
  void look_at_ground(const GroundSurface& surface, const Pose& surface_in_odom);
  CellState state_of(const GroundSurface& surface, const Eigen::Matrix2d& turn,
                     const Eigen::Vector2d& middle) const;
  bool stands_off(const GroundSurface& surface, std::size_t cell) const;
  void cover(const ObstacleList& list, ObstacleKind kind, CellState state);
  void cover(const ConvexPolygon& outline, CellState state);
  void measure_ground(const GroundSurface& surface, const Pose& surface_in_odom);

  GridSettings settings_;
  ObstacleGrid grid_;
};

}  // namespace scree
