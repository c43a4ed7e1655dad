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
  double density_spread =
      3;                   ///< points a square metre where the robot looked most, over where least
  double rim_density = 1;  ///< points a square metre at the rim of the terrain over the middle's,
                           ///< as where the robot stayed there
  double wall_density = 0.6;  ///< of a vertical wall's area, over that of level ground
  double ghosting =
      0.01;  ///< standard deviation of a pass's registration error, metres: three
             ///< passes, each bent smoothly, so that surfaces come out up to 3 cm apart
  bool unseen_patches =
      true;  ///< none behind some of the tall rocks, nor on part of some steep holes' floors
};

/// A terrain as a robot that drove all over it would have reconstructed it: points spread at random
/// over its surface, by area, walls nearly as densely as flat ground, and through its tufts. World
/// frame.
PointCloud reconstructed_cloud(const Terrain& terrain, const CloudSettings& settings,
                               std::uint64_t seed);

}  // namespace scree
