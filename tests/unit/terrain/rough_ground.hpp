#pragma once

#include <cmath>
#include <numbers>

#include "motion/simple_drive.hpp"
#include "scree/config/settings.hpp"
#include "scree/core/sweep.hpp"
#include "scree/motion/deskew.hpp"

namespace scree::test {

/// Uneven ground about z = `level` with slopes to 20 degrees in all directions; or a plane.
struct RoughGround {
  double roughness = 1;
  double level = 0;  ///< metres

  double height(double x, double y) const {
    return level +
           roughness *
               (0.11 * std::sin(1.1 * x + 0.3 * y + 0.5) + 0.09 * std::sin(0.9 * y - 0.4 * x) +
                0.05 * std::sin(2.1 * x + 1.7 * y + 2) + 0.03 * std::sin(3.3 * y - 2.2 * x));
  }
  /// How far a beam goes; 0 when it goes farther than `farthest`.
  double range(const Eigen::Vector3d& from, const Eigen::Vector3d& along, double farthest) const {
    double way = 0;
    for (int i = 0; i < 200 && way < farthest; ++i) {
      const Eigen::Vector3d at = from + way * along;
      const double above = at.z() - height(at.x(), at.y());
      if (above < 1e-4) return way;
      way += 0.75 * above;  // slopes are below 1
    }
    return 0;
  }
};

inline LidarSettings usual_lidar() {
  LidarSettings lidar;
  lidar.translation = {0.1, 0, 0.95};
  lidar.rpy_deg = {0, 6, 0};
  return lidar;
}

/// One turn of 16 lasers over 0.1 s that ends at `end`, seconds.
inline void scan(const RoughGround& ground, const SimpleDrive& drive, const LidarSettings& lidar,
                 double end, Sweep& sweep, int columns = 400) {
  constexpr double kTurn = 0.1, kFarthest = 15;
  const Pose mount = lidar.mount();
  sweep.clear();
  sweep.end_ns = nanoseconds(end);
  for (int column = 0; column < columns; ++column) {
    const double before = kTurn * (columns - 1 - column) / columns;
    const double azimuth = 2 * std::numbers::pi * column / columns;
    const Pose base = drive.base(end - before);
    const Pose at = base * mount;
    for (int laser = 0; laser < 16; ++laser) {
      const double up = radians(2 * laser - 15);
      const Eigen::Vector3d along(std::cos(azimuth) * std::cos(up),
                                  -std::sin(azimuth) * std::cos(up), std::sin(up));
      const double range = ground.range(at.translation, at.rotation * along, kFarthest);
      if (range <= 0) continue;
      sweep.push_back((range * along).cast<float>(), 20,
                      static_cast<std::int32_t>(std::lround(-before * 1e9)),
                      static_cast<std::size_t>(laser));
    }
  }
}

/// Points about the robot on a grid, in `base` at `pose`, as if all were seen from 1 m above it.
inline void look(const RoughGround& ground, const Pose& pose, double reach, double step,
                 DeskewedSweep& sweep) {
  sweep.clear();
  for (double x = -reach; x <= reach; x += step) {
    for (double y = -reach; y <= reach; y += step) {
      const double wx = pose.translation.x() + x, wy = pose.translation.y() + y;
      const Eigen::Vector3d place(wx, wy, ground.height(wx, wy));
      const Eigen::Vector3f seen =
          (pose.rotation.conjugate() * (place - pose.translation)).cast<float>();
      sweep.points.push_back(seen.x(), seen.y(), seen.z(), 20);
      sweep.origins.push_back(Eigen::Vector3f(0, 0, 1));
      sweep.time_ns.push_back(0);
      sweep.scatter.push_back(0);
      sweep.is_isolated.push_back(0);
      sweep.is_moving.push_back(0);
      sweep.is_suspect.push_back(0);
    }
  }
}

}  // namespace scree::test
