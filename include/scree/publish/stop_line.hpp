#pragma once

#include <cstdint>

#include "scree/config/settings.hpp"
#include "scree/core/obstacle.hpp"

namespace scree {

/// Whether an obstacle's outline, its footprint or else its box, overlaps the zone ahead of the
/// robot: in `base`, x from 0 to the length, y to half the width on both sides. One whose place is
/// no number does.
/// @param pose `base` in the frame of the obstacle
bool is_in_zone(const StopSettings& zone, const Pose& pose, const Obstacle& obstacle);

/// Whether an obstacle is in the zone or will be within the hold time, as it moves now.
bool will_be_in_zone(const StopSettings& zone, const Pose& pose, const Obstacle& obstacle);

/// Decides what the stop line says: on while the robot is blind or an obstacle is in the zone or
/// comes into it within the hold time, and for `hold` after that. It begins blind. Times are of any
/// clock that runs steadily.
class StopLine {
public:
  explicit StopLine(const StopSettings& settings) : settings_(settings) {}

  /// From the next list on.
  void set_zone(const StopSettings& settings) { settings_ = settings; }

  void update(const ObstacleList& list, std::int64_t now_ns);
  void set_blind(bool is_blind, std::int64_t now_ns);

  bool is_on(std::int64_t now_ns) const;

private:
  /// To be called before the state changes: what was a reason until now is held from now on.
  void hold(std::int64_t now_ns);

  StopSettings settings_;
  bool is_blind_ = true, is_obstructed_ = false;
  bool was_on_ = false;
  std::int64_t last_reason_ns_ = 0;
};

}  // namespace scree
