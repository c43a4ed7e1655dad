#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace scree {

/// The rotation about a vector by its length in radians.
inline Eigen::Quaterniond exponential(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle < 1e-12) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle));
}

/// The inverse of exponential(): the vector with the shorter angle.
inline Eigen::Vector3d logarithm(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0 ? -1 : 1;
  const double sine = rotation.vec().norm();
  if (sine < 1e-12) return 2 * sign * rotation.vec();
  return 2 * std::atan2(sine, sign * rotation.w()) * sign / sine * rotation.vec();
}

/// Heading of the x axis about z, radians.
inline double yaw_of(const Eigen::Quaterniond& rotation) {
  const Eigen::Vector3d x = rotation * Eigen::Vector3d::UnitX();
  return std::atan2(x.y(), x.x());
}

}  // namespace scree
