#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "scree/motion/pose_filter.hpp"

namespace scree::test {

/// A step of `seconds` from one attitude to the next, straight along x of the robot.
inline MotionStep step_of(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to, double way,
                          double seconds = 0.1) {
  MotionStep step;
  step.end_ns = std::llround(seconds * 1e9);
  step.begin_attitude = from;
  step.attitude = to;
  step.displacement = from.slerp(0.5, to) * Eigen::Vector3d(way, 0, 0);
  step.distance = way;
  step.knows_attitude = step.knows_distance = true;
  return step;
}

inline MotionStep ahead(double way, double seconds = 0.1) {
  const auto level = Eigen::Quaterniond::Identity();
  return step_of(level, level, way, seconds);
}

}  // namespace scree::test
