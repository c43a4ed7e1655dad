#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "scree/config/settings.hpp"
#include "scree/core/pose.hpp"
#include "scree/motion/ground_plane.hpp"

namespace scree {

/// From the end of one sweep to the end of the next, by the lidar alone.
struct LidarStep {
  std::int64_t begin_ns = 0, end_ns = 0;
  Pose step;                         ///< the lidar at the end, in its frame at the begin
  bool is_bound = false;             ///< the ground binds it in all directions
  std::optional<GroundPlane> below;  ///< of the robot's middle, in `lidar`
};

struct ImuAttitude {
  std::int64_t t_ns = 0;
  Eigen::Quaterniond rotation;  ///< see ImuSample::orientation
};

struct WheelWay {
  std::int64_t t_ns = 0;
  double distance = 0;  ///< metres, with the scale that is set
};

/// What each sensor said of a drive, in its own frame and on one clock, oldest first.
struct DriveRecord {
  std::vector<LidarStep> steps;
  std::vector<ImuAttitude> imu;
  std::vector<WheelWay> wheel;
};

/// What a drive can show of a robot's settings. Angles are in degrees, delays in seconds: by how
/// much later than the lidar's a sensor's times are. The y of lidar and wheel show themselves by
/// their difference alone; the lidar's is taken as set.
enum class Calibrated : std::uint8_t {
  lidar_roll,
  lidar_pitch,
  lidar_yaw,
  lidar_x,
  lidar_height,
  imu_roll,
  imu_pitch,
  imu_yaw,
  imu_delay,
  encoder_scale,
  encoder_y,
  encoder_delay,
};
inline constexpr std::size_t kCalibrated = 12;

struct CalibratedValue {
  double value = 0, deviation = 0;  ///< standard deviation, from parts of the drive
  /// Why the drive does not show it; empty where it does. A static text.
  std::string_view why_not;
};

struct Calibration {
  std::array<CalibratedValue, kCalibrated> values;

  const CalibratedValue& operator[](Calibrated which) const {
    return values[static_cast<std::size_t>(which)];
  }
};

/// Mounts, the encoder's scale and place, and delays, from what each sensor measured by itself:
/// - the robot travels along x of `base`, and stands upright on the ground below: lidar rotation
///   and height;
/// - it does not slide sideways when it turns: lidar x;
/// - lidar and IMU turn alike: IMU rotation;
/// - a wheel rolls as far as its place moves: scale and y.
/// Each part of a drive counts less the worse it fits. The lidar must stand upright to 30 degrees,
/// and look forwards to 60.
/// @param set the settings of that drive: the encoder's scale, the places that are not looked for
Calibration calibrate(const DriveRecord& drive, const Settings& set);

/// What the settings say of it.
double set_value(const Settings& set, Calibrated which);

/// Whether the drive shows clearly another value than the settings': by three standard deviations.
bool contradicts(const Calibration& found, const Settings& set, Calibrated which);

/// The settings with what the drive contradicts put right. Of a rotation all three angles are, or
/// none.
Settings with_calibration(Settings set, const Calibration& found);

}  // namespace scree
