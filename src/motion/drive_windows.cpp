#include "drive_windows.hpp"

#include <algorithm>

#include "scree/core/nanoseconds.hpp"
#include "scree/core/rotation.hpp"
#include "scree/motion/setup_window.hpp"

namespace scree {
namespace {

/// Between the two samples around an instant; nothing where they lie far apart.
template <class Sample, class Between>
auto between(const std::vector<Sample>& samples, std::int64_t t_ns, const Between& between_two)
    -> std::optional<decltype(between_two(samples[0], samples[0], 0.0))> {
  constexpr std::int64_t kFar = 50 * kMillisecond;
  const auto after = std::ranges::lower_bound(samples, t_ns, {}, &Sample::t_ns);
  if (after == samples.begin() || after == samples.end()) return std::nullopt;
  const auto before = after - 1;
  if (after->t_ns - before->t_ns > kFar) return std::nullopt;
  const double share =
      static_cast<double>(t_ns - before->t_ns) / static_cast<double>(after->t_ns - before->t_ns);
  return between_two(*before, *after, share);
}

bool is_plausible(const DriveRecord& drive, const DriveWindow& window) {
  const auto by_imu = imu_turn(drive, window.begin_ns, window.end_ns);
  return !by_imu || turn_alike(window.turn, *by_imu);
}

}  // namespace

std::optional<Eigen::Vector3d> imu_turn(const DriveRecord& drive, std::int64_t begin_ns,
                                        std::int64_t end_ns) {
  const auto rotation_at = [&](std::int64_t t_ns) {
    return between(drive.imu, t_ns, [](const ImuAttitude& a, const ImuAttitude& b, double share) {
      return a.rotation.slerp(share, b.rotation);
    });
  };
  const auto begin = rotation_at(begin_ns), end = rotation_at(end_ns);
  if (!begin || !end) return std::nullopt;
  return logarithm(begin->conjugate() * *end);
}

std::optional<double> wheel_way(const DriveRecord& drive, std::int64_t begin_ns,
                                std::int64_t end_ns) {
  const auto distance_at = [&](std::int64_t t_ns) {
    return between(drive.wheel, t_ns, [](const WheelWay& a, const WheelWay& b, double share) {
      return a.distance + share * (b.distance - a.distance);
    });
  };
  const auto begin = distance_at(begin_ns), end = distance_at(end_ns);
  if (!begin || !end) return std::nullopt;
  return *end - *begin;
}

std::vector<DriveWindow> windows_of(const DriveRecord& drive) {
  constexpr double kShortest = 0.45;  // seconds
  std::vector<DriveWindow> windows;
  std::optional<Pose> moved;  // since the window's begin
  DriveWindow window;
  for (const LidarStep& step : drive.steps) {
    if (!step.is_bound || (moved && step.begin_ns != window.end_ns)) moved.reset();
    if (!step.is_bound) continue;
    if (!moved) {
      moved.emplace();
      window.begin_ns = step.begin_ns;
    }
    *moved = *moved * step.step;
    window.end_ns = step.end_ns;
    if (window.seconds() < kShortest) continue;
    window.turn = logarithm(moved->rotation);
    window.way = exponential(-window.turn / 2) * moved->translation;
    if (is_plausible(drive, window)) windows.push_back(window);
    moved.reset();
  }
  return windows;
}

}  // namespace scree
