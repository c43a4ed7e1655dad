#pragma once

#include "scree/detect/plane_cells.hpp"

namespace scree {

/// Removes what the robot passes under: branches, ceilings, bridges. The paper has no such stage,
/// but an elevation that averages a canopy with the ground below it is nobody's height.
class Overhangs {
public:
  /// Edge of the columns, metres: wide enough to see some ground beside a trunk, narrow enough for
  /// a slope of 45 degrees to stay within any sensible clearance.
  static constexpr float kColumn = 1.0F;

  explicit Overhangs(std::size_t max_points) : heights_(max_points) {}

  /// Takes out of `cloud` the points more than `clearance` metres above the ground of their column.
  /// That ground is the third-lowest point, so that one or two stray points below it do no harm.
  /// @param columns is working memory
  /// @pre as PlaneCells::build() with a radius of kRadius
  void remove(PointCloud& cloud, float clearance, PlaneCells& columns);

  /// The radius for which PlaneCells has columns of kColumn.
  static constexpr float kRadius = 3 * kColumn;

private:
  FixedVector<float> heights_;
};

}  // namespace scree
