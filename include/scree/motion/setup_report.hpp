#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace scree {

/// What of a robot's settings the sensors contradict.
enum class SetupFault : std::uint8_t {
  lidar_height,    ///< lidar.translation, z
  lidar_rotation,  ///< lidar.rpy_deg
  imu_rotation,    ///< imu.rpy_deg
  encoder_scale,   ///< encoder.scale, or its sign
  encoder_place,   ///< encoder.translation, y
  lidar_unset,     ///< lidar.translation and lidar.rpy_deg are as delivered
};
inline constexpr std::size_t kSetupFaults = 6;

struct SetupFinding {
  SetupFault fault = SetupFault::lidar_unset;
  bool is_grave = false;  ///< lists cannot be right
  /// How far it is off: metres too low, degrees, times too large (below zero: of the wrong sign).
  double off = 0;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< of a rotation, in `base`
  Eigen::Vector3d set = Eigen::Vector3d::Zero();   ///< what the key should say; of a number the x
};

/// One sentence, with the key and what to set it to.
std::string sentence(const SetupFinding& finding);

/// What is wrong at present, gravest first.
struct SetupReport {
  std::array<SetupFinding, kSetupFaults> findings;
  std::size_t count = 0;

  const SetupFinding* begin() const { return findings.data(); }
  const SetupFinding* end() const { return findings.data() + count; }
  bool is_grave() const { return count > 0 && findings[0].is_grave; }
};

}  // namespace scree
