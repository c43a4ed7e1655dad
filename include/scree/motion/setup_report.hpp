#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "scree/motion/own_returns.hpp"

namespace scree {

/// What of a robot's settings the sensors contradict.
enum class SetupFault : std::uint8_t {
  lidar_height,    ///< lidar.translation, z
  lidar_rotation,  ///< lidar.rpy_deg
  imu_rotation,    ///< imu.rpy_deg
  encoder_scale,   ///< encoder.scale, or its sign
  encoder_place,   ///< encoder.translation, y
  imu_delay,       ///< imu.delay
  encoder_delay,   ///< encoder.delay
  lidar_unset,     ///< lidar.translation and lidar.rpy_deg are as delivered
  motion_unknown,  ///< nothing tells how the robot moves: each sweep is taken by itself
  robot_body,      ///< robot.body lacks a box; the last, since there may be several
};
inline constexpr std::size_t kSetupFaults = 10;
inline constexpr std::size_t kMostFindings = kSetupFaults - 1 + OwnReturns::kMostFound;

struct SetupFinding {
  SetupFault fault = SetupFault::lidar_unset;
  bool is_grave = false;  ///< lists cannot be right
  /// How far it is off: metres too low, degrees, times too large (below zero: of the wrong sign),
  /// seconds too late.
  double off = 0;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< of a rotation, in `base`
  /// What the key should say; of a number the x, of a box the low corner.
  Eigen::Vector3d set = Eigen::Vector3d::Zero();
  Eigen::Vector3d high = Eigen::Vector3d::Zero();  ///< the other corner of a box
};

/// One sentence, with the key and what to set it to.
std::string sentence(const SetupFinding& finding);

/// What is wrong at present, gravest first.
struct SetupReport {
  std::array<SetupFinding, kMostFindings> findings;
  std::size_t count = 0;

  const SetupFinding* begin() const { return findings.data(); }
  const SetupFinding* end() const { return findings.data() + count; }
  /// @return false when full
  bool add(const SetupFinding& finding) {
    if (count == findings.size()) return false;
    findings[count++] = finding;
    return true;
  }
  /// Calls visit(slot, finding) for each: slots below kMostFindings, one for each fault, and for
  /// boxes of the body those from their fault's on.
  template <class Visit>
  void for_each_slot(Visit&& visit) const {
    std::size_t boxes = 0;
    for (const SetupFinding& each : *this) {
      const auto fault = static_cast<std::size_t>(each.fault);
      visit(each.fault == SetupFault::robot_body ? fault + boxes++ : fault, each);
    }
  }
  bool is_grave() const { return count > 0 && findings[0].is_grave; }
};

}  // namespace scree
