#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "simulator/terrain.hpp"

namespace scree {

/// Where straight beams meet a terrain. Blocks of the raster that a beam passes above are skipped:
/// three sizes of them, each four times as wide as the one before.
class RayCaster {
public:
  /// Keeps a reference to the terrain.
  explicit RayCaster(const Terrain& terrain);

  /// Distance from the origin to the surface, metres, right to about a millimetre; none when the
  /// beam ends or leaves the terrain first. Features narrower than a cell may be missed.
  /// @pre direction has length 1, origin lies above the ground
  std::optional<double> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_range) const;

private:
  struct Level {
    std::size_t blocks;          // a side
    double block_size;           // metres
    std::vector<float> highest;  // height in each block
  };
  std::optional<double> march(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                              double from, double to) const;

  const Terrain& terrain_;
  std::array<Level, 3> levels_;  // from the smallest blocks to the largest
  double top_;
};

}  // namespace scree
