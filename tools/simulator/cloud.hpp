#pragma once

#include <cstddef>
#include <cstdint>

#include "scree/core/point_cloud.hpp"
#include "simulator/terrain.hpp"

namespace scree {

struct CloudSettings {
  std::size_t points = 914'608;     ///< as many as the paper's cloud has (fig. 10)
  double noise = 0.01;              ///< standard deviation of each coordinate, metres
  double scattered_share = 0.0005;  ///< points that belong to nothing: dust, wrong matches
};

/// A terrain as a robot that drove all over it would have reconstructed it: points spread at random
/// over its surface, evenly by area, walls as densely as flat ground. World frame.
PointCloud reconstructed_cloud(const Terrain& terrain, const CloudSettings& settings,
                               std::uint64_t seed);

}  // namespace scree
