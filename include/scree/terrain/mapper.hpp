#pragma once

#include <cstdint>
#include <optional>

#include "scree/config/settings.hpp"
#include "scree/core/stage_times.hpp"
#include "scree/core/sweep.hpp"
#include "scree/motion/dead_reckoning.hpp"
#include "scree/motion/deskew.hpp"
#include "scree/motion/levelling.hpp"
#include "scree/motion/pose_filter.hpp"
#include "scree/motion/slip_detector.hpp"
#include "scree/sync/sync_buffer.hpp"
#include "scree/terrain/moving_points.hpp"
#include "scree/terrain/registration.hpp"
#include "scree/terrain/rolling_map.hpp"
#include "scree/terrain/surfel_map.hpp"

namespace scree {

/// Rebuilds the ground around the robot: each sweep is moved to its end by dead reckoning, laid
/// onto the ground seen so far, and added to the rolling map. The map has a frame of its own, with
/// the origin and the yaw of `odom`. It is tilted by the error of the IMU's attitude at the first
/// sweep; to_odom() lays it level. Memory is taken once, when it is made.
class Mapper {
public:
  explicit Mapper(const Settings& settings);

  /// @param sensors gathered, and covering the sweep as far as they ever will
  /// @param timer started; takes the time of each stage
  void add(const Sweep& sweep, const SyncBuffer& sensors, StageTimer& timer);
  void add(const Sweep& sweep, const SyncBuffer& sensors) {
    StageTimer none;
    add(sweep, sensors, none);
  }

  /// Adds what has come of a turn before it ends: laid into the map where the sensors say that the
  /// robot is. What corrects their motion waits for the turn's end.
  /// @param sensors as in add()
  void add_part(const Sweep& sweep, const SyncBuffer& sensors, StageTimer& timer);

  bool registers() const { return registers_; }
  /// Begins anew, at the origin: what comes next does not follow on what came before.
  void restart();
  /// Other sensors tell the motion from now on. Forgets the ground, whose vertical may be another,
  /// and goes on from where it is.
  void change_sensors();
  /// Forgets the ground, and goes on from where it is.
  void forget_ground();
  /// Takes a sweep by itself, as if the robot stood still. The map stays as it is.
  void take_still(const Sweep& sweep);

  /// `base` in the map's frame at the end of the last sweep, or of the last part of it.
  const Pose& pose() const { return part_pose_ ? *part_pose_ : filter_.pose(); }
  /// The map's frame in `odom`, as far as it is known by now.
  const Pose& to_odom() const { return levelling_.to_odom(); }
  const PoseFilter& filter() const { return filter_; }
  const RollingMap& map() const { return map_; }
  /// As RollingMap::remove_left() and remove_trail().
  bool remove_left(const Obstacle& obstacle, bool was_left) {
    return map_.remove_left(obstacle, was_left) || map_.remove_trail(obstacle);
  }
  void update_cloud() { map_.update_cloud(); }
  const MotionStep& step() const { return step_; }
  const Registration::Outcome& registration() const { return outcome_; }
  /// Whether the map began anew with the last sweep, because its frame was found wrong or
  /// the robot's own returns have left a trail in it.
  bool was_reset() const { return was_reset_; }
  /// Sweeps during which the wheel slipped.
  std::uint64_t slips() const { return slips_; }
  /// What moves in the last sweep.
  const MovingPoints& moving() const { return moving_; }
  const OwnReturns& own_returns() const { return own_returns_; }
  /// The last sweep in `base` at its end.
  const DeskewedSweep& sweep() const { return sweep_; }

private:
  static std::int64_t begin_of(const Sweep& sweep);
  double reach() const;
  void detect_slip(const SyncBuffer& sensors, std::int64_t end_ns);
  bool notice_own_returns();
  void add_surfels();
  void update_attitude_error(const Eigen::Quaterniond& predicted, bool was_silent);
  void extrapolate_motion(const Pose& before);

  LidarSettings lidar_;
  bool registers_;
  double surfel_reach_, search_reach_;
  DeadReckoning dead_reckoning_;
  SlipDetector slip_detector_;
  std::uint64_t slips_ = 0;
  bool was_reset_ = false;
  double attitude_error_ = 0;  // rad, within a sweep; 0 while the IMU measures it
  SweepTrajectory trajectory_;
  OwnReturns own_returns_;
  DeskewedSweep sweep_;
  TakenTurn taken_;
  PoseFilter filter_;
  std::optional<Pose> part_pose_;
  Levelling levelling_;
  Registration registration_;
  SurfelMap surfels_;
  MovingPoints moving_;
  RollingMap map_;
  MotionStep step_;
  Registration::Outcome outcome_;
};

}  // namespace scree
