#pragma once

#include <cstdint>
#include <vector>

#include "scree/core/pose.hpp"

namespace scree {

/// Where the robot said that it was, and where it truly was.
struct PosePair {
  std::int64_t t_ns;
  Pose reported, truth;
};

/// How far dead reckoning strayed.
struct PoseError {
  double way = 0;      ///< length of the true way from pose to pose, metres
  double seconds = 0;  ///< from the first to the last pose
  double last = 0;     ///< distance of the last reported position from the true one, metres
  double most = 0;     ///< the greatest such distance
  double yaw = 0;      ///< of the last reported pose against the true one, radians, +-pi
  double share() const { return way > 0 ? last / way : 0; }
  double yaw_per_minute() const { return seconds > 0 ? yaw / seconds * 60 : 0; }
};

/// Lays the first reported pose onto the true one by position and yaw, and compares the others.
PoseError pose_error(const std::vector<PosePair>& poses);

}  // namespace scree
