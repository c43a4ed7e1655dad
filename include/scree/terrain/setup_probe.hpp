#pragma once

#include <cstdint>

#include "scree/config/settings.hpp"
#include "scree/core/sweep.hpp"
#include "scree/motion/setup_watch.hpp"
#include "scree/sync/sync_buffer.hpp"
#include "scree/terrain/lidar_odometry.hpp"

namespace scree {

/// Feeds a SetupWatch: sums up what lidar, IMU and encoder measure over half a second. Memory is
/// taken once, when it is made.
class SetupProbe {
public:
  explicit SetupProbe(const Settings& settings);

  /// @param sensors gathered, and covering the sweep as far as they ever will
  /// @return as LidarOdometry::add()
  bool add(const Sweep& sweep, const SyncBuffer& sensors);

  const SetupReport& report() const { return watch_.report(); }
  const LidarOdometry& odometry() const { return odometry_; }

private:
  void begin_window();
  void add_step(const SyncBuffer& sensors);
  void end_window(const SyncBuffer& sensors);

  Eigen::Vector3d middle_;  // above the robot's, at the lidar's height, in `lidar`
  LidarOdometry odometry_;
  SetupWatch watch_;
  SetupWindow window_;
  std::int64_t begin_ns_ = 0;
};

}  // namespace scree
