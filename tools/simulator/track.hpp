#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace scree {

/// Where a robot drives, seen from above, at one moment.
struct TrackPoint {
  Eigen::Vector2d position;  ///< metres
  double yaw = 0;            ///< radians, whither it looks
  double speed = 0;          ///< m/s, below zero where it drives backwards
};

struct TrackSettings {
  double seconds = 20;
  double speed = 0;      ///< mean speed while driving, m/s; 0: drawn from 0.4 to 1.6
  bool reverse = false;  ///< drives backwards for a stretch, more slowly
  bool turns = false;    ///< stops and turns on the spot
};

inline constexpr std::int64_t kTrackStepNs = 2'500'000;

/// A smooth curved way, a point each kTrackStepNs: it may stand at first and stop on the way,
/// drives at 0.3 to 2 m/s that vary smoothly, turns at up to 0.6 rad/s and stays within about 12 m
/// of the origin. Where it is to drive backwards it does so for 3 to 6 s, or a third of a shorter
/// way, somewhere in the middle. Where it is to turn it stops there for 4 to 8 s, or half of a
/// shorter way, and turns on the spot at up to 0.8 rad/s. The same seed gives the same way.
std::vector<TrackPoint> draw_track(const TrackSettings& settings, std::uint64_t seed);

/// Points along the way about 0.25 m apart.
std::vector<Eigen::Vector2d> thinned(const std::vector<TrackPoint>& track);

}  // namespace scree
