#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "scree/drivers/xsens/measurement.hpp"

namespace scree::xsens {

/// The rotation from the sensor's axes into east-north-up, whatever local frame and parameters were
/// sent: the quaternion, else the matrix, else the Euler angles. Nothing when there is none, or its
/// frame is none of the known ones.
std::optional<Eigen::Quaterniond> orientation_enu(const Measurement& measurement);

}  // namespace scree::xsens
