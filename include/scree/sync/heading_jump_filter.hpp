#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "scree/core/imu_sample.hpp"

namespace scree {

/// Takes jumps out of the yaw of an IMU. A heading reset, a correction by the magnetometer or a
/// filter that settles turns the orientation by what the sensor itself has not turned, and the
/// angular rate in the same messages knows nothing of it.
class HeadingJumpFilter {
public:
  /// Corrects one sample after the other, each with an orientation. Where the rate is missing, or
  /// after a pause, the orientation is believed.
  void correct(ImuSample& sample);
  /// What comes next does not follow on what came before.
  void restart() { has_before_ = false; }
  /// How often a jump was taken out.
  std::uint64_t corrections() const { return corrections_; }

private:
  ImuSample before_;
  bool has_before_ = false;
  double correction_ = 0;  // rad of yaw, of every sample from now on
  // Sums over the last second, older ones fading.
  double unexplained_ = 0;       // rad of yaw that the rate does not account for
  double turned_ = 0;            // rad of yaw, each way
  double noise_ = 0;             // variance of what noise adds to the unexplained, rad^2
  double last_unexplained_ = 0;  // in the last sample, rad
  std::uint64_t corrections_ = 0;
};

}  // namespace scree
