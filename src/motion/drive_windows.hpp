#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "scree/motion/calibration.hpp"

namespace scree {

/// Half a second in which the ground bound the lidar.
struct DriveWindow {
  std::int64_t begin_ns = 0, end_ns = 0;
  Eigen::Vector3d way = Eigen::Vector3d::Zero();   ///< in `lidar` half way, metres
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  ///< rotation vector, rad
  double seconds() const { return static_cast<double>(end_ns - begin_ns) * 1e-9; }
};

/// Without those in which lidar and IMU turn by other angles: registration lost its way.
std::vector<DriveWindow> windows_of(const DriveRecord& drive);

/// By the IMU from one instant to another: a rotation vector in `imu`. Nothing while it was silent.
std::optional<Eigen::Vector3d> imu_turn(const DriveRecord& drive, std::int64_t begin_ns,
                                        std::int64_t end_ns);
/// How far the wheel rolled, metres.
std::optional<double> wheel_way(const DriveRecord& drive, std::int64_t begin_ns,
                                std::int64_t end_ns);

}  // namespace scree
