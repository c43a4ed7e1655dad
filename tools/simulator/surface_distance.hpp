#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "scree/core/point_cloud.hpp"
#include "scree/core/pose.hpp"
#include "simulator/terrain.hpp"

namespace scree {

/// Distance of a point to the nearest point of the terrain's surface, metres: to the two triangles
/// of each of the raster's cells, so that a point on a wall is as near as it is, whatever the
/// height above it or below. @pre the terrain covers the point
double distance_to_surface(const Terrain& terrain, const Eigen::Vector3d& point);

/// How far a cloud lies from the true surface.
struct SurfaceError {
  std::size_t points = 0;        ///< that were compared
  std::size_t near_volumes = 0;  ///< left out: grass or a plant is there, but no surface
  double squares = 0;            ///< sum of the squared distances, square metres

  double rms() const;  ///< metres, NaN without points
  SurfaceError& operator+=(const SurfaceError& other);
};

/// @param to_world of the cloud's points
SurfaceError surface_error(const Terrain& terrain, PointView cloud, const Pose& to_world);

}  // namespace scree
