#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "scree/sync/sync_buffer.hpp"

namespace scree {

inline constexpr double kGravity = 9.81;  // m/s^2

/// The specific force that the IMU felt from one instant to another, summed up in its level frame,
/// m/s. Nothing when it has hardly said.
std::optional<Eigen::Vector3d> felt_during(const SampleHistory<ImuSample>& imu,
                                           std::int64_t begin_ns, std::int64_t end_ns);

/// By how much `base` became faster along its x axis, as the IMU felt it, m/s.
/// @param mount, origin of the IMU in `base`
std::optional<double> made_faster(const SyncBuffer& sensors, std::int64_t begin_ns,
                                  std::int64_t end_ns, const Eigen::Quaterniond& mount,
                                  const Eigen::Vector3d& origin);

}  // namespace scree
