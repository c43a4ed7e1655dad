#pragma once

#include <cstdint>
#include <filesystem>

#include "scree/config/settings.hpp"
#include "scree/core/result.hpp"

namespace scree {

/// The sensors of a simulated robot and where they are mounted: what its scree.toml says.
struct Robot {
  LidarSettings lidar;
  ImuSettings imu;
  EncoderSettings encoder;

  /// `imu` in `base`.
  Pose imu_mount() const;
};

/// The robot of every other seed carries its lidar 0.95 m up, looking 6 degrees down, its IMU's
/// axes along its own, and counts 32 bits. Those of the others differ in heights, angles and in the
/// signal of the encoder.
Robot draw_robot(std::uint64_t seed);

/// These settings with the robot's sensors in place of theirs.
Settings with_sensors_of(const Robot& robot, Settings settings);

/// Writes scree.toml with the three sensors' tables.
Result<void> write_robot(const std::filesystem::path& file, const Robot& robot);

}  // namespace scree
