#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "scree/core/imu_sample.hpp"
#include "scree/core/random.hpp"
#include "simulator/motion.hpp"
#include "simulator/xbus.hpp"

namespace scree {

/// Errors of an MTi-7xx and its mounting. Standard deviations where nothing else is said.
struct SimulatedImuSettings {
  double rate_hz = 100;                 ///< 100 to 400
  double gyro_noise = 0.0009;           ///< of a sample, rad/s
  double gyro_bias = 0.0015;            ///< at the start, rad/s
  double gyro_walk = 3e-5;              ///< of the bias, rad/s in a second
  double gyro_vibration = 0.008;        ///< of a sample at 1 m/s: the motors' vibration, rad/s
  double acceleration_noise = 0.005;    ///< of a sample, m/s^2
  double acceleration_bias = 0.03;      ///< m/s^2
  double acceleration_vibration = 0.3;  ///< of a sample at 1 m/s, m/s^2
  double tilt_error = 0.006;            ///< of roll and pitch, rad
  double tilt_correlation = 25;         ///< seconds
  double yaw_drift = 0.0005;            ///< of the drift's rate, rad/s
  double yaw_offset = 0;        ///< of the terrain's x axis from east, counter-clockwise, rad
  double clock_skew = 0;        ///< seconds a second that its clock gains
  bool has_orientation = true;  ///< false: an MTi-1 or MTi-100, which sends none
};

/// What an Xsens MTi-7xx fixed to a moving robot measures, one sample at a time. Rates and
/// accelerations are those of the motion over 5 ms about the sample's time.
class SimulatedImu {
public:
  /// Keeps a reference to the motion.
  /// @param mount `imu` in `base`
  /// @param start_ns host's time of the first sample
  SimulatedImu(const Motion& motion, const Pose& mount, const SimulatedImuSettings& settings,
               std::int64_t start_ns, std::uint64_t seed);

  ImuMessage next();

private:
  Pose sensor(std::int64_t t_ns) const;
  Eigen::Vector3d normal();
  void wander();

  const Motion& motion_;
  Pose mount_;
  SimulatedImuSettings settings_;
  std::int64_t start_ns_;
  Random random_;
  std::int64_t samples_ = 0;
  std::uint16_t first_counter_;
  std::uint32_t first_tick_;
  Eigen::Vector3d gyro_bias_, acceleration_bias_;
  Eigen::Vector2d tilt_;
  double yaw_, yaw_rate_;
};

/// What a decoder makes of an undamaged message.
ImuSample sample_of(const ImuMessage& message);

}  // namespace scree
