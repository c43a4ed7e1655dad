#pragma once

#include <cstddef>
#include <cstdint>

#include "scoring/truth.hpp"
#include "scree/config/settings.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/core/sweep.hpp"
#include "simulator/cloud.hpp"
#include "simulator/terrain.hpp"

namespace scree {

/// A terrain with one reconstructed cloud of it, and what a list for it is scored against.
struct CloudWorld {
  CloudWorld(const TerrainSettings& ground, const CloudSettings& settings, std::uint64_t seed);
  /// A cloud of the default kind.
  CloudWorld(const TerrainSettings& ground, std::size_t points, std::uint64_t seed);

  Terrain terrain;
  PointCloud cloud;
  Truth truth;
};

/// The scenes in turn, for a robot at rest in their middle.
TerrainSettings around_the_robot(std::uint64_t seed);

/// Such a terrain, one turn of a lidar there, and what a list for it is scored against: asked for
/// are the obstacles that this turn shows well enough (see Visibility).
struct SweepWorld {
  /// @param lidar of which model, and its mount
  /// @param rate_hz turns a second
  SweepWorld(const LidarSettings& lidar, double rate_hz, std::uint64_t seed);

  Terrain terrain;
  Sweep sweep;  ///< points without times
  Truth truth;
};

}  // namespace scree
