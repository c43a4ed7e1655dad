#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "scree/sync/sync_buffer.hpp"

namespace scree {

/// The integral of the IMU's specific force from one instant to another, in its level frame, m/s.
/// Nothing where the acceleration is missing for more than half of the time.
std::optional<Eigen::Vector3d> integrate_specific_force(const SampleHistory<ImuSample>& imu,
                                                        std::int64_t begin_ns, std::int64_t end_ns);

/// By how much the velocity of `base` along its x axis changed by the IMU, m/s.
/// @param mount rotation imu -> base
/// @param origin of the IMU in `base`, metres
std::optional<double> forward_velocity_change(const SyncBuffer& sensors, std::int64_t begin_ns,
                                              std::int64_t end_ns, const Eigen::Quaterniond& mount,
                                              const Eigen::Vector3d& origin);

}  // namespace scree
