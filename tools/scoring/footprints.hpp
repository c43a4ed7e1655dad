#pragma once

#include <Eigen/Core>
#include <vector>

namespace scree {

/// A polygon seen from above: corners in order, either way round, not closed. Metres.
using Outline = std::vector<Eigen::Vector2d>;

/// The same outline; its convex hull when it crosses or touches itself; empty when it has no area.
Outline uncrossed(Outline outline);

/// Distance to the nearest point of the polygon, 0 inside. @pre an outline of uncrossed(), not
/// empty
double distance_to(const Outline& polygon, const Eigen::Vector2d& point);

/// Area that two polygons share over the area that they cover together, 0..1; 0 for one without
/// area. @pre outlines of uncrossed(), or rectangles
double intersection_over_union(const Outline& a, const Outline& b);

/// Between the two parallel lines that stand closest and hold the polygon between them, metres. A
/// ditch is as wide as a robot that drives over it sees it. 0 for less than three corners.
double least_width(const Outline& polygon);

}  // namespace scree
