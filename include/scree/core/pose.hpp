#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace scree {

constexpr double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}
constexpr double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}

/// A child frame in its parent: p_parent = rotation * p_child + translation (metres).
struct Pose {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation;
  }
  /// A grandchild's frame in the parent.
  Pose operator*(const Pose& child) const {
    return {*this * child.translation, rotation * child.rotation};
  }
  /// The parent's frame in the child.
  Pose inverse() const {
    const Eigen::Quaterniond back = rotation.conjugate();
    return {-(back * translation), back};
  }
  /// As a matrix, for many points.
  Eigen::Isometry3d isometry() const { return Eigen::Translation3d(translation) * rotation; }
};

/// Rz(yaw) Ry(pitch) Rx(roll), angles in radians.
inline Eigen::Quaterniond from_roll_pitch_yaw(double roll, double pitch, double yaw) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
         AngleAxisd(roll, Vector3d::UnitX());
}

}  // namespace scree
