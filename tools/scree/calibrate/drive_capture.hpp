#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "scree/config/settings.hpp"
#include "scree/motion/calibration.hpp"

namespace scree::cli {

struct DriveCapture {
  DriveRecord record;
  /// Now and then a sweep, as far as a few metres, in `lidar`.
  std::vector<Eigen::Vector3d> near;
};

/// Reads a capture as what each of its sensors says of the drive. Says on stderr what was refused
/// or lost. Throws Failure when no packet of the lidar was accepted.
/// @param config empty for the capture's own
/// @param settings where the lidar is mounted, for the ground below the robot
DriveCapture read_drive(const std::filesystem::path& capture, const std::filesystem::path& config,
                        const Settings& settings);

}  // namespace scree::cli
