#pragma once

#include <cstdint>
#include <vector>

#include "simulator/motion.hpp"
#include "simulator/terrain.hpp"
#include "simulator/track.hpp"

namespace scree {

/// How a robot's body follows the ground under its four wheels.
struct BodySettings {
  double wheelbase = 0.7;     ///< metres between the axles
  double gauge = 0.6;         ///< metres between left and right wheels
  double suspension = 0.08;   ///< seconds over which it smooths the ground
  double vibration = 0.0015;  ///< metres at 1 m/s, the slowest of several frequencies
  double shaking = 0.002;     ///< radians at 1 m/s, likewise, in roll and pitch
};

/// Draws a body: its measures differ from robot to robot.
BodySettings draw_body(std::uint64_t seed);

/// The body's pose all along a track: a plane through the points where the wheels stand, smoothed
/// by the suspension, and vibration whose frequencies and strength grow with the speed. `base` lies
/// on that plane below the robot's centre.
Motion follow_ground(const std::vector<TrackPoint>& track, const Terrain& terrain,
                     const BodySettings& settings, std::int64_t start_ns, std::uint64_t seed);

}  // namespace scree
