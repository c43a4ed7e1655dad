#pragma once

#include "scree/detect/plane_cells.hpp"

namespace scree {

/// Edge of the columns of remove_overhangs(), metres: wide enough to see some ground beside a
/// trunk, narrow enough for a slope of 45 degrees to stay within any sensible clearance.
constexpr float kOverhangColumn = 1;
/// The radius for which PlaneCells has such columns, metres.
constexpr float kOverhangRadius = 3 * kOverhangColumn;

/// Removes what the robot passes under: branches, ceilings, bridges. The paper has no such stage,
/// but an elevation that averages a canopy with the ground below it is nobody's height.
///
/// Takes out of `cloud` the points more than `clearance` metres above the ground of their column.
/// That ground is the third-lowest point, so that one or two stray points below it do no harm.
/// @param columns is working memory
/// @pre as PlaneCells::build() with kOverhangRadius
void remove_overhangs(PointCloud& cloud, float clearance, PlaneCells& columns);

}  // namespace scree
