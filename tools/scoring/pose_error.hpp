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
  double way = 0;       ///< length of the true way from pose to pose, metres
  double seconds = 0;   ///< from the first to the last pose
  double last = 0;      ///< distance of the last reported position from the true one, metres
  double most = 0;      ///< the greatest such distance
  double yaw = 0;       ///< of the last reported pose against the true one, radians, +-pi
  double most_yaw = 0;  ///< the greatest such angle, without its sign

  double share() const { return of_way(last); }
  double most_share() const { return of_way(most); }
  double yaw_per_minute() const { return a_minute(yaw); }
  double most_yaw_per_minute() const { return a_minute(most_yaw); }

private:
  double of_way(double distance) const { return way > 0 ? distance / way : 0; }
  double a_minute(double angle) const { return seconds > 0 ? angle / seconds * 60 : 0; }
};

/// The turn about z and the shift that lay one pose onto another by position and yaw.
Pose laid_onto(const Pose& pose, const Pose& other);

/// Lays the first reported pose onto the true one by position and yaw, and compares the others.
PoseError pose_error(const std::vector<PosePair>& poses);

}  // namespace scree
