#pragma once

#include <cstddef>

namespace scree {

/// Points and obstacles at each stage of one cloud (the paper's chain is 914,608 -> 413,591 ->
/// 82,242 -> 26,011), and what did not fit.
struct StageCounts {
  std::size_t input = 0;               ///< points given
  std::size_t dropped = 0;             ///< beyond the detector's room for points
  std::size_t refused = 0;             ///< not finite, or too far out for the cells
  std::size_t voxels = 0;              ///< after the voxel grid
  std::size_t below_clearance = 0;     ///< without what the robot passes under
  std::size_t known = 0;               ///< with a gradient
  std::size_t candidates = 0;          ///< steep, or off the ground's surface
  std::size_t candidates_dropped = 0;  ///< beyond the detector's room for candidates
  std::size_t kept = 0;                ///< after suppression, or without isolated points
  std::size_t blocks = 0;              ///< super-voxels
  std::size_t blocks_kept = 0;         ///< of enough points
  std::size_t clusters = 0;            ///< of enough points or super-voxels
  std::size_t obstacles = 0;           ///< by the network
  std::size_t obstacles_dropped = 0;   ///< beyond the room in the list
};

}  // namespace scree
