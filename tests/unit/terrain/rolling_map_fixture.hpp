#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "scree/terrain/rolling_map.hpp"

namespace scree::test {

/// A map and its clock.
class RollingMapFixture : public testing::Test {
public:
  static constexpr std::int64_t kStart = 1'598'612'523'000'000'000, kTurnNs = 100'000'000;
  static constexpr double kVoxel = 0.05;
  static constexpr float kScatter = 0.03F;

protected:
  MapSettings settings_{.voxel = kVoxel, .reach = 12};
  static constexpr std::size_t kMaxVoxels = 1 << 16;
  RollingMap map_{settings_, kMaxVoxels};
  DeskewedSweep sweep_{1 << 15};
  Pose pose_;
  std::int64_t now_ns_ = kStart;

  /// @param point in `odom`
  /// @param is_isolated whether no other shot ended near it
  void see(const Eigen::Vector3d& point, bool is_isolated = false) {
    const Eigen::Vector3f seen =
        (pose_.rotation.conjugate() * (point - pose_.translation)).cast<float>();
    sweep_.points.push_back(seen.x(), seen.y(), seen.z(), 20);
    sweep_.origins.push_back(Eigen::Vector3f(0, 0, 1));
    sweep_.scatter.push_back(kScatter);
    sweep_.is_isolated.push_back(is_isolated ? 1 : 0);
    sweep_.is_moving.push_back(0);
    sweep_.is_suspect.push_back(0);
  }
  /// A beam from the lidar into the sky, or what else gives no return.
  void see_nothing(const Eigen::Vector3d& along) {
    const Eigen::Vector3f origin(0, 0, 1);
    const Eigen::Vector3d end = kNoReturnRange * (pose_.rotation.conjugate() * along.normalized());
    sweep_.empty.push_back({origin, origin + end.cast<float>()});
  }
  void end_sweep(double reach = std::numeric_limits<double>::infinity()) {
    map_.add(sweep_, pose_, now_ns_ += kTurnNs, reach);
    sweep_.clear();
  }
  void wait(int sweeps) {
    for (int i = 0; i < sweeps; ++i) end_sweep();
  }
  Eigen::Vector3d confirmed(std::size_t i) const {
    const PointCloud& cloud = map_.cloud();
    return map_.origin() + Eigen::Vector3d(cloud.x[i], cloud.y[i], cloud.z[i]);
  }
  bool has_near(const Eigen::Vector3d& place, double distance = 0.03) const {
    for (std::size_t i = 0; i < map_.cloud().size(); ++i) {
      if ((confirmed(i) - place).norm() < distance) return true;
    }
    return false;
  }
};

}  // namespace scree::test
