#include "simulator/body.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "simulator/curves.hpp"

namespace scree {
namespace {

constexpr double kStep = static_cast<double>(kTrackStepNs) * 1e-9;

/// Height of the body's plane and its slopes forwards and to the left.
using Stance = Eigen::Vector3d;

/// A wheel is round: it rests on the ground around the point below its axle.
double ground_under_wheel(const Terrain& terrain, const Eigen::Vector2d& at) {
  constexpr double kPatch = 0.06;
  double sum = terrain.height(at.x(), at.y());
  sum += terrain.height(at.x() - kPatch, at.y()) + terrain.height(at.x() + kPatch, at.y());
  sum += terrain.height(at.x(), at.y() - kPatch) + terrain.height(at.x(), at.y() + kPatch);
  return sum / 5;
}

Stance stance(const Terrain& terrain, const TrackPoint& point, const BodySettings& settings) {
  const Eigen::Vector2d forward(std::cos(point.yaw), std::sin(point.yaw));
  const Eigen::Vector2d left(-forward.y(), forward.x());
  const auto wheel = [&](double ahead, double aside) {
    return ground_under_wheel(terrain, point.position + ahead * settings.wheelbase / 2 * forward +
                                           aside * settings.gauge / 2 * left);
  };
  const double front_left = wheel(1, 1);
  const double front_right = wheel(1, -1);
  const double rear_left = wheel(-1, 1);
  const double rear_right = wheel(-1, -1);
  return {(front_left + front_right + rear_left + rear_right) / 4,
          (front_left + front_right - rear_left - rear_right) / (2 * settings.wheelbase),
          (front_left - front_right + rear_left - rear_right) / (2 * settings.gauge)};
}

/// First order, forwards and backwards, so that the body does not lag behind its wheels; twice.
void smooth(std::vector<Stance>& stances, double seconds) {
  const double gain = 1 - std::exp(-kStep / (seconds / 2));
  for (int pass = 0; pass < 2; ++pass) {
    Stance state = stances.front();
    for (Stance& value : stances) value = state += gain * (value - state);
    for (auto value = stances.rbegin(); value != stances.rend(); ++value) {
      *value = state += gain * (*value - state);
    }
  }
}

/// Sines whose frequencies follow the speed, weaker the faster they are.
class Vibration {
public:
  explicit Vibration(Random& random) {
    for (std::size_t i = 0; i < waves_.size(); ++i) {
      const double frequency = kSlowest * std::pow(2.0, static_cast<double>(i)) *
                               random.uniform(0.75, 1.3);  // Hz at 1 m/s
      const double strength =
          random.uniform(0.4, 1) / (1 + std::pow(frequency / kSlowest, 1.7) / 3);
      waves_[i] = {kTurn * frequency, random.uniform(0, kTurn), strength};
    }
  }

  double advance(double speed) {
    double sum = 0;
    for (Wave& wave : waves_) {
      wave.phase += wave.rate * (0.4 + 0.6 * speed) * kStep;
      sum += wave.strength * std::sin(wave.phase);
    }
    return sum * std::min(speed, 1.5);
  }

private:
  static constexpr double kSlowest = 3.5;
  struct Wave {
    double rate, phase, strength;
  };
  std::array<Wave, 4> waves_{};
};

}  // namespace

BodySettings draw_body(std::uint64_t seed) {
  Random random(seed, 0xB0D1);
  BodySettings settings;
  settings.wheelbase = random.uniform(0.45, 0.95);
  settings.gauge = random.uniform(0.4, 0.8);
  settings.suspension = random.uniform(0.04, 0.15);
  settings.vibration = random.uniform(0.0003, 0.002);
  settings.shaking = random.uniform(0.0005, 0.003);
  return settings;
}

Motion follow_ground(const std::vector<TrackPoint>& track, const Terrain& terrain,
                     const BodySettings& settings, std::int64_t start_ns, std::uint64_t seed) {
  Random random(seed, 0xB0D2);
  std::vector<Stance> stances;
  stances.reserve(track.size());
  for (const TrackPoint& point : track) stances.push_back(stance(terrain, point, settings));
  smooth(stances, settings.suspension);
  std::array vibrations = {Vibration(random), Vibration(random), Vibration(random)};
  std::vector<Pose> knots;
  knots.reserve(track.size());
  for (std::size_t i = 0; i < track.size(); ++i) {
    const TrackPoint& point = track[i];
    const Stance& on = stances[i];
    const double speed = std::abs(point.speed);
    const double up = settings.vibration * vibrations[0].advance(speed);
    const double roll = std::atan(on[2]) + settings.shaking * vibrations[1].advance(speed);
    const double pitch = -std::atan(on[1]) + settings.shaking * vibrations[2].advance(speed);
    knots.push_back({{point.position.x(), point.position.y(), on[0] + up},
                     from_roll_pitch_yaw(roll, pitch, point.yaw)});
  }
  return {std::move(knots), start_ns, kTrackStepNs};
}

}  // namespace scree
