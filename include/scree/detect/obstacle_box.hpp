#pragma once

#include <Eigen/Core>
#include <array>

#include "scree/core/obstacle.hpp"

// An obstacle's box in the horizontal plane, in metres, in the frame of its list.

namespace scree {

/// A place in the frame of the box: along its length, and across.
Eigen::Vector2d in_box_frame(const Obstacle& box, const Eigen::Vector3d& place);

/// The four corners, at the height of the box's centre.
std::array<Eigen::Vector3d, 4> corners_of(const Obstacle& box);

/// The distance of a place from the box; 0 inside.
double distance_to_box(const Obstacle& box, const Eigen::Vector3d& place);

/// The distance between two boxes, measured at corners and centres; 0 where one of them lies in the
/// other box.
double distance_between_boxes(const Obstacle& a, const Obstacle& b);

}  // namespace scree
