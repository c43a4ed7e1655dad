#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "scree/config/settings.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/obstacle_grid.hpp"
#include "scree/core/stage_times.hpp"
#include "scree/core/sweep.hpp"
#include "scree/detect/detector.hpp"
#include "scree/detect/grid_maker.hpp"
#include "scree/detect/moving_boxes.hpp"
#include "scree/detect/moving_tracker.hpp"
#include "scree/detect/tracker.hpp"
#include "scree/sync/sync_buffer.hpp"
#include "scree/terrain/mapper.hpp"
#include "scree/terrain/setup_probe.hpp"
#include "scree/terrain/stand_in_motion.hpp"

namespace scree {

/// The networks that a pipeline needs.
struct Networks {
  Network map, sweep;            ///< of detect.map and detect.sweep
  std::optional<Network> judge;  ///< of tracks
};

/// From sweeps and motion samples to obstacle lists: the daemon and `scree detect` both run this.
/// Each sweep is added to the map, and obstacles are found in the map; what moves is found in the
/// sweep itself, and stays out of the map. As long as no IMU has said anything, the lidar's own
/// odometry stands in for it, and for an encoder. Where neither is heard and the ground does not
/// show how the lidar moves, each sweep is taken by itself instead, and `odom` is `base`; an
/// obstacle then keeps its id while it moves little from sweep to sweep. Of a turn that has not
/// ended only the points go into the map, where IMU or encoder say how the robot moves: what moves,
/// and what corrects the pose, is found at its end. Where a sensor is first heard the map begins
/// anew; where the lidar's odometry goes on after it did not hold, `odom` does, too. Memory is
/// taken once, when it is made.
class Pipeline {
public:
  /// @param config_file its folder is searched first for the weights files; it may be empty
  static Result<Pipeline> make(const Settings& settings, const std::filesystem::path& config_file);
  Pipeline(const Settings& settings, const Networks& networks);

  /// Where the IMU's and the encoder's threads put their samples.
  SyncBuffer& sensors() { return *sensors_; }
  /// @param sweep a turn, or what has come of it before its end
  /// @return the list of this sweep; valid until the next call. That of a part counts only where it
  /// has_looked().
  const ObstacleList& process(const Sweep& sweep);
  /// What is free, occupied or unknown around the robot, with the last list; null when lcm.grid is
  /// off, or the list is not from the map's surface. Valid until the next call of process().
  const ObstacleGrid* grid() const { return grid_; }
  /// From the next sweep on.
  void set_tracking(const TrackingSettings& settings) { tracker_.set(settings); }

  /// Whether the last list says what is there, so that an empty one says that nothing is. It does
  /// when the sweep was a whole turn and the map, where there is one, holds points. After its first
  /// sweep the map holds none yet.
  bool has_looked() const { return has_looked_; }
  /// From the next sweep on the stages are timed on that clock.
  void time_stages(StageTimer::Clock clock) { timer_ = StageTimer(clock); }

  /// How long the stages of the last list took; none without time_stages().
  const StageTimes& stage_times() const { return timer_.times(); }
  /// What found the obstacles of the last list, and in which points.
  const Detector& detector() const { return uses_map() ? map_detector_ : *sweep_detector_; }
  const PointCloud& ground() const {
    return uses_map() ? mapper_->map().cloud() : mapper_->sweep().points;
  }
  const Mapper& mapper() const { return *mapper_; }
  /// The settings that the sensors contradict.
  const SetupReport& setup() const { return setup_report_; }
  const Tracker& tracker() const { return uses_map() ? tracker_ : sweep_tracker_; }
  /// What the trackers had no room for, standing or moving.
  std::uint64_t tracks_dropped() const {
    return tracker().dropped() + moving_tracker_.dropped() + moving_boxes_.dropped();
  }
  /// Whether the last list is from the map, not from a sweep by itself.
  bool uses_map() const { return uses_map_; }
  /// What the detector counted in the last sweep; points that did not get to it are dropped ones.
  StageCounts counts() const;

private:
  void process_turn(const Sweep& sweep);
  void process_part(const Sweep& sweep);
  bool had_room();
  float turns_since_list(const Sweep& sweep);
  void follow_motion(const Sweep& sweep);
  const SyncBuffer* choose_motion() const;
  bool starts_over(const Sweep& sweep, bool follows);
  void clear_tracks();
  void report_setup();
  void detect_in_map(bool ends_turn);
  void find_moving();
  float ground_at(const Eigen::Vector3d& place) const;
  void detect_in_sweep(const Pose& pose);

  std::unique_ptr<SyncBuffer> sensors_;
  std::unique_ptr<Mapper> mapper_;
  std::unique_ptr<SetupProbe> setup_;
  SetupReport setup_report_;
  std::unique_ptr<StandInMotion> stand_in_;
  const SyncBuffer* motion_ = nullptr;  // sensors_, stand_in_, or none of them
  bool has_map_ = false, uses_map_ = false;
  Detector map_detector_;
  std::optional<Detector> sweep_detector_;  // until IMU or encoder is heard
  Tracker tracker_, sweep_tracker_;
  MovingTracker moving_tracker_;
  MovingBoxes moving_boxes_;
  FixedVector<Obstacle> found_;
  ObstacleList list_;
  std::optional<GridMaker> grid_maker_;
  const ObstacleGrid* grid_ = nullptr;
  StageTimer timer_;
  bool has_looked_ = false;
  std::uint64_t map_dropped_ = 0;  // points, until the turn before
  float turns_ = 1;                // since the list before
  std::int64_t turn_ns_ = 0;       // what the last turn took
  bool is_within_turn_ = false;
  std::int64_t lidar_restart_ns_ = 0;  // of which it is not known yet what it means; 0: of none
};

/// The weights in a file that a setting names.
Result<Network> load_network(const std::string& name, const std::filesystem::path& config_file);
Result<Networks> load_networks(const Settings& settings, const std::filesystem::path& config_file);
/// A detector with its weights, for clouds (detect.cloud). The network must not ask for features
/// that the method has not.
Result<Detector> make_detector(const DetectSettings& settings, const DetectorLimits& limits,
                               const std::filesystem::path& config_file);

}  // namespace scree
