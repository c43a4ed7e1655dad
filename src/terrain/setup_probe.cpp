#include "scree/terrain/setup_probe.hpp"

#include "scree/core/gravity.hpp"
#include "scree/core/rotation.hpp"
#include "scree/motion/specific_force.hpp"

namespace scree {
namespace {

std::optional<Eigen::Vector3d> imu_turn(const SyncBuffer& sensors, std::int64_t begin_ns,
                                        std::int64_t end_ns) {
  const auto begin = sensors.attitude_at(begin_ns), end = sensors.attitude_at(end_ns);
  if (!begin || !end) return std::nullopt;
  return logarithm(begin->rotation.conjugate() * end->rotation);
}

std::optional<double> wheel_way(const SyncBuffer& sensors, std::int64_t begin_ns,
                                std::int64_t end_ns) {
  const auto begin = sensors.wheel_at(begin_ns), end = sensors.wheel_at(end_ns);
  if (!begin || !end) return std::nullopt;
  return end->distance - begin->distance;
}

}  // namespace

SetupProbe::SetupProbe(const Settings& settings)
    : middle_(LidarOdometry::above_middle(settings.lidar.mount())),
      odometry_(static_cast<std::size_t>(settings.memory.sweep_points),
                OwnReturns(settings.robot.body, settings.lidar.mount())),
      watch_(settings) {
  begin_window();
}

void SetupProbe::begin_window() {
  window_ = {};
  window_.binds = window_.has_imu = window_.has_wheel = true;
  begin_ns_ = odometry_.end_ns();
}

bool SetupProbe::add(const Sweep& sweep, const SyncBuffer& sensors) {
  constexpr double kWindow = 0.45;  // seconds
  const bool follows = odometry_.add(sweep);
  if (follows) add_step(sensors);
  if (follows && window_.seconds < kWindow) return true;
  if (follows) {
    end_window(sensors);
    watch_.add(window_);
  }
  begin_window();
  return follows;
}

/// The way from the sweep before to the last one.
void SetupProbe::add_step(const SyncBuffer& sensors) {
  const std::int64_t begin_ns = odometry_.begin_ns(), end_ns = odometry_.end_ns();
  window_.seconds += static_cast<double>(end_ns - begin_ns) * 1e-9;
  window_.way += odometry_.step().translation;
  window_.turn += logarithm(odometry_.step().rotation);
  window_.binds = window_.binds && odometry_.is_bound();
  constexpr auto kBeforeNs = static_cast<std::int64_t>(SetupWindow::kBefore * 1e9);
  const auto add = [&](const auto& measured, bool& has_all, auto& sum, auto& sum_before) {
    const auto now = measured(sensors, begin_ns, end_ns);
    const auto before = measured(sensors, begin_ns - kBeforeNs, end_ns - kBeforeNs);
    has_all = has_all && now && before;
    if (!has_all) return;
    sum += *now;
    sum_before += *before;
  };
  add(imu_turn, window_.has_imu, window_.imu_turn, window_.imu_turn_before);
  add(wheel_way, window_.has_wheel, window_.wheel, window_.wheel_before);
}

void SetupProbe::end_window(const SyncBuffer& sensors) {
  window_.is_bound =
      window_.binds && (!window_.has_imu || turn_alike(window_.turn, window_.imu_turn));
  window_.around = fit_ground_around(odometry_.sweep().points);
  if (window_.is_bound) window_.below = odometry_.ground_below(middle_);
  const auto attitude = sensors.attitude_at(odometry_.end_ns());
  if (!window_.has_imu || !attitude) return;
  const auto force = integrate_specific_force(sensors.imu(), begin_ns_, odometry_.end_ns());
  window_.imu_up = attitude->rotation.conjugate() * Eigen::Vector3d::UnitZ();
  if (!force) return;
  const Eigen::Vector3d moved = *force / window_.seconds - Eigen::Vector3d(0, 0, kGravity);
  window_.has_force = true;
  window_.imu_force = attitude->rotation.conjugate() * moved;
}

}  // namespace scree
