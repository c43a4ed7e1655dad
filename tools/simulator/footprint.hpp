#pragma once

#include <Eigen/Core>
#include <vector>

namespace scree {

/// Outline of an obstacle seen from above: corners in order, not closed, metres.
using Footprint = std::vector<Eigen::Vector2d>;

bool contains(const Footprint& footprint, const Eigen::Vector2d& point);
/// The convex hull of some points, counter-clockwise. @pre three of them are no line
Footprint hull(std::vector<Eigen::Vector2d> points);
/// Distance to the nearest point of the footprint; 0 inside. Infinite for an empty footprint.
double distance(const Footprint& footprint, const Eigen::Vector2d& point);
/// Least distance of two footprints; 0 where they overlap.
double distance(const Footprint& a, const Footprint& b);

}  // namespace scree
