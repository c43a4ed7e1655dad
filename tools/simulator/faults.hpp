#pragma once

#include <cstdint>

namespace scree {

/// A stretch of time in which a sensor is silent. Seconds; times count from the capture's begin.
struct Gap {
  double start = 0;
  double seconds = 0;  ///< 0: there is none

  double end() const { return start + seconds; }
  bool holds(double t) const { return t >= start && t < end(); }
};

/// What goes wrong between the sensors and the host.
struct Faults {
  double packet_loss = 0.001;  ///< share of the lidar's data packets that get lost
  double imu_corruption = 0;   ///< share of the IMU's serial bytes flipped, dropped or inserted
  Gap imu_gap;                 ///< the device runs on, but its messages get lost
  Gap encoder_gap;             ///< the same for its frames; those of others stay on the bus
};

/// The shortest drive that has room for draw_faults().
inline constexpr double kLeastFaultySeconds = 15;

/// Faults that a robot has to live with: one lidar packet in a hundred lost, one IMU message in a
/// hundred corrupted, an IMU gap of 2 s and an encoder gap of 3 s. The gaps lie at times of this
/// seed, in either order, 2 s or more apart, and neither in the first 3 s nor the last 2 s.
/// @pre seconds >= kLeastFaultySeconds
Faults draw_faults(double seconds, std::uint64_t seed);

}  // namespace scree
