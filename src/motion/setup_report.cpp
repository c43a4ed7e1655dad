#include "scree/motion/setup_report.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "scree/config/settings.hpp"

namespace scree {
namespace {

/// Rounded, and without the sign of a zero.
std::string vector_text(const Eigen::Vector3d& vector, double digits) {
  const auto rounded = [&](double value) { return std::round(value * digits) / digits + 0.0; };
  return fmt::format("[{:g}, {:g}, {:g}]", rounded(vector.x()), rounded(vector.y()),
                     rounded(vector.z()));
}

/// The axis that a rotation is mostly about.
const char* axis_name(const Eigen::Vector3d& axis) {
  constexpr std::array kNames = {"x", "y", "z"};
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return kNames[static_cast<std::size_t>(largest)];
}

/// "5.2 degrees about y (pitch)"
std::string turn_text(const SetupFinding& finding) {
  return fmt::format("{:.0f} degrees about {}", std::abs(finding.off), axis_name(finding.axis));
}

std::string scale_text(const SetupFinding& finding) {
  const double factor = std::abs(finding.off);
  std::string text = "encoder.scale looks";
  if (finding.off < 0) text += " of the wrong sign";
  const bool is_far = factor > 1.25 || factor < 0.8;
  if (is_far) {
    text += fmt::format("{} {:.1f} times too {}", finding.off < 0 ? " and" : "",
                        std::max(factor, 1 / factor), factor > 1 ? "large" : "small");
  }
  return text + fmt::format(": set {:.3g}", finding.set.x());
}

std::string delay_text(const char* sensor, const SetupFinding& finding) {
  const double set = std::round(finding.set.x() * 100) / 100 + 0.0;
  const std::string text = fmt::format("{}.delay looks {:.2f} s too {}: ", sensor,
                                       std::abs(finding.off), finding.off > 0 ? "small" : "large");
  if (std::abs(set) <= kMostDelay) return text + fmt::format("set {:g}", set);
  return text +
         fmt::format("more than the key takes; find what holds up the {}",
                     finding.off > 0 ? fmt::format("{}'s messages", sensor) : "lidar's packets");
}

}  // namespace

std::string sentence(const SetupFinding& finding) {
  switch (finding.fault) {
    case SetupFault::lidar_height:
      return fmt::format("lidar.translation looks {:.2f} m too {}: set {}", std::abs(finding.off),
                         finding.off > 0 ? "low" : "high", vector_text(finding.set, 100));
    case SetupFault::lidar_rotation:
      return fmt::format("lidar.rpy_deg looks turned by {}: set {}", turn_text(finding),
                         vector_text(finding.set, 1));
    case SetupFault::imu_rotation:
      return fmt::format("imu.rpy_deg looks turned by {}: set {}", turn_text(finding),
                         vector_text(finding.set, 1));
    case SetupFault::encoder_scale:
      return scale_text(finding);
    case SetupFault::encoder_place:
      return fmt::format("encoder.translation looks {:.2f} m too far to the {}: set {}",
                         std::abs(finding.off), finding.off > 0 ? "left" : "right",
                         vector_text(finding.set, 100));
    case SetupFault::imu_delay:
      return delay_text("imu", finding);
    case SetupFault::encoder_delay:
      return delay_text("encoder", finding);
    case SetupFault::lidar_unset:
      return "lidar.translation and lidar.rpy_deg are as delivered: set where the lidar sits";
    case SetupFault::motion_unknown:
      return "no IMU and no encoder is heard, and the ground does not show the lidar how it moves: "
             "each sweep is taken by itself";
    case SetupFault::robot_body:
      return fmt::format(
          "returns keep their place on the robot and are left out: add the box [{}, {}] to "
          "robot.body",
          vector_text(finding.set, 100), vector_text(finding.high, 100));
  }
  return "";
}

}  // namespace scree
