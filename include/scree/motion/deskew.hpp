#pragma once

#include "scree/config/settings.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/core/sweep.hpp"
#include "scree/motion/own_returns.hpp"
#include "scree/motion/sweep_trajectory.hpp"

namespace scree {

/// A beam without return.
struct EmptyBeam {
  Eigen::Vector3f origin, end;  ///< metres; kNoReturnRange apart
};

/// A sweep as it would look from where `base` was at its end.
struct DeskewedSweep {
  PointCloud points;                      ///< in `base` at the sweep's end
  FixedVector<Eigen::Vector3f> origins;   ///< the lidar's origin at each point's time, same frame
  FixedVector<std::int32_t> time_ns;      ///< of each point, relative to the sweep's end
  FixedVector<float> scatter;             ///< of each point, see RangeScatter; metres
  FixedVector<std::uint8_t> is_isolated;  ///< whether it ends alone, see RangeScatter
  FixedVector<std::uint8_t>
      is_moving;  ///< set by MovingPoints: whether it is on something that moves
  FixedVector<std::uint8_t> is_suspect;  ///< whether it may be the robot's own, see OwnReturns
  FixedVector<EmptyBeam> empty;          ///< same frame
  // Those before are in the map already, where a part of the turn was looked at before its end.
  std::size_t fresh_points = 0, fresh_empty = 0;
  bool begins_turn = true;  ///< whether none of the turn was
  std::size_t dropped = 0;

  explicit DeskewedSweep(std::size_t capacity)
      : points(capacity),
        origins(capacity),
        time_ns(capacity),
        scatter(capacity),
        is_isolated(capacity),
        is_moving(capacity),
        is_suspect(capacity),
        empty(capacity) {}

  void clear() {
    points.clear();
    origins.clear();
    time_ns.clear();
    scatter.clear();
    is_isolated.clear();
    is_moving.clear();
    is_suspect.clear();
    empty.clear();
    dropped = 0;
    take_all();
  }
  /// Whatever of the turn was in the map has been forgotten.
  void take_all() {
    fresh_points = fresh_empty = 0;
    begins_turn = true;
  }
};

/// How much of a turn is in the map.
struct TakenTurn {
  std::uint64_t turn = 0;  ///< see Sweep
  std::size_t points = 0, empty = 0;
};

/// Moves every point of a sweep, in the `lidar` frame, to `base` at the sweep's end by the motion
/// within it. Leaves out points nearer than min_range and farther than max_range, and the robot's
/// own.
/// @param taken of this turn or of another one
void deskew(const Sweep& sweep, const LidarSettings& lidar, const SweepTrajectory& trajectory,
            OwnReturns& own, DeskewedSweep& out, const TakenTurn& taken = {});

}  // namespace scree
