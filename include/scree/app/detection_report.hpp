#pragma once

#include <cstdint>
#include <limits>

#include "scree/core/obstacle_grid.hpp"
#include "scree/core/stage_times.hpp"
#include "scree/motion/setup_report.hpp"

namespace scree {

/// What did not fit in the memory of map, detector and tracker, since the start.
struct DropCounts {
  std::uint64_t points = 0, edge_points = 0, obstacles = 0;  ///< dropped by the detector
  std::uint64_t map_points = 0, tracks = 0;
  std::uint64_t points_refused = 0;  ///< by the detector: no numbers, or too far off
};

/// How well the robot's motion is known, and what was not believed of it since the start.
struct MotionReport {
  /// Standard deviations of the pose: the larger one of x and y, metres, and the yaw's, rad. No
  /// numbers where each sweep is taken by itself.
  double position_deviation = std::numeric_limits<double>::quiet_NaN();
  double yaw_deviation = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t slips = 0;           ///< sweeps during which the wheel slipped
  std::uint64_t heading_resets = 0;  ///< see HeadingJumpFilter
};

/// What is reported beside the obstacle list of one sweep.
struct DetectionReport {
  DropCounts drops;
  MotionReport motion;
  SetupReport setup{};  ///< the settings that the sensors contradict
  StageTimes stage_times{};
  const ObstacleGrid* grid = nullptr;  ///< valid as long as the list; null without one
};

}  // namespace scree
