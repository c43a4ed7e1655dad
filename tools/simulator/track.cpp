#include "simulator/track.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scree/core/random.hpp"
#include "simulator/curves.hpp"

namespace scree {
namespace {

constexpr double kTrackStep = static_cast<double>(kTrackStepNs) * 1e-9;

/// With no jerk at its ends.
double smoother(double t) {
  const double x = std::clamp(t, 0.0, 1.0);
  return x * x * x * (x * (x * 6 - 15) + 10);
}

/// Smooth random function, about -1..1.
class Waves {
public:
  Waves(Random& random, double shortest, double longest) {
    for (Wave& wave : waves_) {
      wave = {kTurn / random.uniform(shortest, longest), random.uniform(0, kTurn)};
    }
  }
  double operator()(double x) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::sin(wave.rate * x + wave.phase);
    return sum / static_cast<double>(waves_.size());
  }

private:
  struct Wave {
    double rate, phase;
  };
  std::array<Wave, 3> waves_{};
};

/// Speed over time: stands, drives off, may stop once or drive backwards once.
class SpeedProfile {
public:
  SpeedProfile(const TrackSettings& settings, Random& random, Random& backing, Random& spinning)
      : mean_(settings.speed > 0 ? settings.speed : random.uniform(0.4, 1.6)),
        variation_(random.uniform(0.1, 0.45)),
        waves_(random, 5, 16),
        stands_(std::min(random.uniform(0, 2.2), 0.1 * settings.seconds)),
        drives_off_(random.uniform(0.8, 2.0)) {
    const bool stops = settings.seconds > 12 && random.chance(0.25);
    const double at = random.uniform(0.4, 0.8) * settings.seconds;
    if (stops && !settings.reverse) stop_ = at;
    if (settings.turns) {
      stop_ = spinning.uniform(0.3, 0.6) * settings.seconds;
      stopped_ = std::min(spinning.uniform(4, 8), settings.seconds / 2);
      spin_ = spinning.uniform(0.3, 0.8) * (spinning.chance(0.5) ? 1 : -1);
    }
    if (!settings.reverse) return;
    backs_ = backing.uniform(0.3, 0.5) * settings.seconds;
    forwards_ = backs_ + std::min(backing.uniform(3, 6), settings.seconds / 3);
  }

  double operator()(double t) const {
    const double wanted = std::clamp(mean_ * (1 + variation_ * waves_(t)), 0.3, 2.0);
    const double away = std::abs(t - stop_) - stopped_ / 2;
    const double going = std::min(smoother((t - stands_) / drives_off_), smoother(away / kBraking));
    if (t < backs_ - kBraking || t > forwards_ + kBraking) return wanted * going;
    const double turned = std::min(std::abs(t - backs_), std::abs(t - forwards_));
    const double direction = t > backs_ && t < forwards_ ? -0.6 : 1;
    return direction * wanted * std::min(going, smoother(turned / kBraking));
  }
  /// Of turning on the spot, rad/s.
  double spin(double t) const {
    const double within = stopped_ / 2 - std::abs(t - stop_);
    return spin_ * smoother(within / kBraking);
  }

private:
  static constexpr double kBraking = 1.2;  // seconds
  double mean_, variation_;
  Waves waves_;
  double stands_, drives_off_;
  double stop_ = -1e9, backs_ = -1e9, forwards_ = -1e9;
  double stopped_ = 1, spin_ = 0;
};

}  // namespace

std::vector<TrackPoint> draw_track(const TrackSettings& settings, std::uint64_t seed) {
  constexpr double kArena = 9;          // metres; beyond it the robot turns back
  constexpr double kMostTurning = 0.6;  // rad/s
  Random random(seed, 0x7AC4);
  Random backing(seed, 0x7AC6);
  Random spinning(seed, 0x7AC7);
  const SpeedProfile speed_at(settings, random, backing, spinning);
  const Waves bends(random, 4, 16);
  const double sharpest = random.uniform(0.1, 0.4);
  const auto points = static_cast<std::size_t>(std::ceil(settings.seconds / kTrackStep)) + 1;
  std::vector<TrackPoint> track(points);
  track[0].yaw = random.uniform(-std::numbers::pi, std::numbers::pi);
  track[0].position = {random.uniform(-3, 3), random.uniform(-3, 3)};
  double driven = 0;
  double curvature = sharpest * bends(0);
  for (std::size_t i = 0; i + 1 < points; ++i) {
    TrackPoint& here = track[i];
    here.speed = speed_at(static_cast<double>(i) * kTrackStep);
    double wanted = sharpest * bends(driven);
    if (here.position.norm() > kArena) {
      const double home = std::atan2(-here.position.y(), -here.position.x());
      wanted += 0.35 * std::sin(home - here.yaw) * smoother((here.position.norm() - kArena) / 3);
      if (std::cos(home - here.yaw) < 0) wanted = std::copysign(0.4, std::sin(home - here.yaw));
    }
    const double most = kMostTurning / std::max(std::abs(here.speed), 0.3);
    curvature += (std::clamp(wanted, -most, most) - curvature) * kTrackStep / 0.5;
    const double moved = here.speed * kTrackStep;
    driven += moved;
    const double spun = speed_at.spin(static_cast<double>(i) * kTrackStep) * kTrackStep;
    track[i + 1].yaw = here.yaw + moved * curvature + spun;
    const double heading = here.yaw + moved * curvature / 2;
    track[i + 1].position =
        here.position + moved * Eigen::Vector2d(std::cos(heading), std::sin(heading));
  }
  track.back().speed = speed_at(static_cast<double>(points - 1) * kTrackStep);
  return track;
}

std::vector<Eigen::Vector2d> thinned(const std::vector<TrackPoint>& track) {
  constexpr double kThinnedApart = 0.25;
  std::vector<Eigen::Vector2d> points;
  for (const TrackPoint& point : track) {
    if (points.empty() || (point.position - points.back()).norm() >= kThinnedApart) {
      points.push_back(point.position);
    }
  }
  return points;
}

}  // namespace scree
