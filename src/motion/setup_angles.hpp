#pragma once

#include <Eigen/Core>
#include <array>

namespace scree {

/// The inverse of from_roll_pitch_yaw(), degrees.
Eigen::Vector3d roll_pitch_yaw_deg(const Eigen::Matrix3d& rotation);

/// All rotations that lay axes onto axes: none, then half turns about x, y and z, then the others.
std::array<Eigen::Matrix3d, 24> all_quarter_turns();

}  // namespace scree
