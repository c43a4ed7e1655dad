#pragma once

#include <Eigen/Core>
#include <optional>

#include "scree/core/point_cloud.hpp"

namespace scree {

/// The ground as one plane, as it is seen from a frame above it.
struct GroundPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< upwards
  double height = 0;                                  ///< above it, metres
};

/// The plane that most points around a lidar lie on, and the height of their frame's origin.
/// Nothing where too little lies below the lidar, or where many points lie well below the plane: it
/// is one through grass then.
/// @param points in the lidar's frame, which stands upright to half a right angle
std::optional<GroundPlane> fit_ground_around(const PointCloud& points);

/// The plane through points of the ground, and the height of a place above it.
/// @pre some points
GroundPlane fit_ground_below(const PointCloud& points, const Eigen::Vector3d& place);

}  // namespace scree
