#include "scree/motion/specific_force.hpp"

#include <algorithm>

#include "scree/core/gravity.hpp"

namespace scree {

std::optional<Eigen::Vector3d> integrate_specific_force(const SampleHistory<ImuSample>& imu,
                                                        std::int64_t begin_ns,
                                                        std::int64_t end_ns) {
  constexpr double kLeastKnown = 0.5;  // share of the time
  const double seconds = static_cast<double>(end_ns - begin_ns) * 1e-9;
  Eigen::Vector3d integral = Eigen::Vector3d::Zero();
  std::int64_t known_ns = 0;
  const std::size_t end = imu.count_until(end_ns);
  for (std::size_t i = std::max<std::size_t>(imu.count_until(begin_ns), 1); i < end; ++i) {
    const ImuSample& sample = imu[i];
    const std::int64_t since_ns = sample.t_ns - imu[i - 1].t_ns;
    if (!sample.has_acceleration || since_ns > SyncBuffer::kSilenceNs) continue;
    integral += sample.orientation * sample.acceleration * (static_cast<double>(since_ns) * 1e-9);
    known_ns += since_ns;
  }
  const double known = static_cast<double>(known_ns) * 1e-9;
  if (known < kLeastKnown * seconds) return std::nullopt;
  return integral * (seconds / known);
}

std::optional<double> forward_velocity_change(const SyncBuffer& sensors, std::int64_t begin_ns,
                                              std::int64_t end_ns, const Eigen::Quaterniond& mount,
                                              const Eigen::Vector3d& origin) {
  const auto begin = sensors.attitude_at(begin_ns), end = sensors.attitude_at(end_ns);
  const auto force = integrate_specific_force(sensors.imu(), begin_ns, end_ns);
  if (!begin || !end || !force) return std::nullopt;
  // The IMU swings about the origin of `base`.
  const Eigen::Vector3d arm = mount.conjugate() * origin;
  const auto swing = [&arm](const Attitude& imu) -> Eigen::Vector3d {
    return imu.rotation * imu.rate.cross(arm);
  };
  const double seconds = static_cast<double>(end_ns - begin_ns) * 1e-9;
  const Eigen::Vector3d change =
      *force - Eigen::Vector3d(0, 0, kGravity * seconds) - (swing(*end) - swing(*begin));
  const Eigen::Vector3d ahead = end->rotation * (mount.conjugate() * Eigen::Vector3d::UnitX());
  return change.dot(ahead);
}

}  // namespace scree
