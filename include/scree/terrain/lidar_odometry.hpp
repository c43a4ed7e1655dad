#pragma once

#include <cstdint>
#include <optional>

#include "scree/core/sweep.hpp"
#include "scree/motion/deskew.hpp"
#include "scree/motion/ground_plane.hpp"
#include "scree/motion/twist_filter.hpp"
#include "scree/terrain/registration.hpp"
#include "scree/terrain/surfel_map.hpp"

namespace scree {

/// How the lidar moved, by its sweeps alone: each is laid onto the surfels of those before. It
/// needs no mount, no IMU and no encoder, so that they can be held against it. Where the ground
/// binds a direction too little the deviations are large. Memory is taken once, when it is made.
class LidarOdometry {
public:
  /// @param own leaves out what the robot's body returns
  LidarOdometry(std::size_t max_points, OwnReturns own);

  /// @return false for the first sweep, and after a pause
  bool add(const Sweep& sweep);

  /// The lidar's pose at the last sweep's end in its frame at the end of the one before.
  const Pose& step() const { return step_; }
  std::int64_t begin_ns() const { return begin_ns_; }
  std::int64_t end_ns() const { return end_ns_; }
  /// Whether the ground binds the step in all directions.
  bool is_bound() const;
  /// The ground below a place, from the surfels of earlier sweeps; nothing where too little of it
  /// was seen.
  /// @param place in the lidar's frame; above the ground, near the robot's middle
  std::optional<GroundPlane> ground_below(const Eigen::Vector3d& place);
  /// The place above the robot's middle, at the lidar's height, in `lidar`.
  static Eigen::Vector3d above_middle(const Pose& lidar_mount);
  const DeskewedSweep& sweep() const { return sweep_; }

private:
  void add_surfels();

  LidarSettings lidar_;
  OwnReturns own_;
  SweepTrajectory trajectory_;
  DeskewedSweep sweep_;
  TwistFilter filter_;
  Registration registration_;
  SurfelMap surfels_;
  Registration::Outcome outcome_;
  PointCloud ground_{64};
  Pose step_;
  std::int64_t begin_ns_ = 0, end_ns_ = 0;
};

}  // namespace scree
