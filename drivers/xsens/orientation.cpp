#include "scree/drivers/xsens/orientation.hpp"

#include <numbers>

#include "scree/core/pose.hpp"

namespace scree::xsens {
namespace {

/// From a local frame into east-north-up; only the local frame differs, the sensor's axes stay
/// (MTi User Manual, "Coordinate systems").
std::optional<Eigen::Quaterniond> to_enu(LocalFrame frame) {
  constexpr double kHalf = std::numbers::sqrt2 / 2;
  switch (frame) {
    case LocalFrame::enu:
      return Eigen::Quaterniond::Identity();
    case LocalFrame::ned:  // half a turn about the axis between north and east
      return Eigen::Quaterniond(0, kHalf, kHalf, 0);
    case LocalFrame::nwu:  // north lies a quarter of a turn to the left of east
      return Eigen::Quaterniond(kHalf, 0, 0, kHalf);
  }
  return std::nullopt;
}

}  // namespace

std::optional<Eigen::Quaterniond> orientation_enu(const Measurement& measurement) {
  Eigen::Quaterniond orientation;
  LocalFrame frame{};
  if (const auto& quaternion = measurement.quaternion) {
    const auto& [w, x, y, z] = quaternion->value;
    orientation = Eigen::Quaterniond(w, x, y, z);
    frame = quaternion->frame;
  } else if (const auto& matrix = measurement.rotation_matrix) {
    orientation = Eigen::Matrix3d(Eigen::Map<const Eigen::Matrix3d>(matrix->value.data()));
    frame = matrix->frame;
  } else if (const auto& euler = measurement.euler_angles) {
    const auto& [roll, pitch, yaw] = euler->value;
    orientation = from_roll_pitch_yaw(radians(roll), radians(pitch), radians(yaw));
    frame = euler->frame;
  } else {
    return std::nullopt;
  }
  const auto local = to_enu(frame);
  if (!local) return std::nullopt;
  return (*local * orientation).normalized();
}

}  // namespace scree::xsens
