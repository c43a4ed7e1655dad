#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <cstdint>

#include "scree/core/pose.hpp"

namespace scree {

/// Where `base` (or a sensor on it) was during a sweep, in `base` at the sweep's end, in equal
/// steps of time.
class SweepTrajectory {
public:
  static constexpr std::int64_t kLongestStepNs = 5'000'000;
  static constexpr std::size_t kMaxSteps = 64;  ///< over the 0.22 s of the longest sweep

  struct Transform {
    Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
    Eigen::Vector3f translation = Eigen::Vector3f::Zero();  ///< metres
  };

  /// Standing still.
  SweepTrajectory() : transforms_(1) {}
  /// @param step_ns below 1 counts as 1: sweeps of broken clocks may have no length
  void start(std::int64_t step_ns) {
    transforms_.clear();
    step_ns_ = std::max<std::int64_t>(step_ns, 1);
  }
  /// Takes one instant after the other, from the end backwards. False when full.
  bool push_back(const Transform& transform) {
    if (transforms_.size() == transforms_.capacity()) return false;
    transforms_.push_back(transform);
    return true;
  }
  /// The trajectory of a sensor that is mounted so, sensor -> base.
  SweepTrajectory of_sensor(const Pose& mount) const;
  /// @param before_end_ns not below zero; before the trajectory's begin its first transform answers
  Transform at(std::int64_t before_end_ns) const;

private:
  boost::container::static_vector<Transform, kMaxSteps + 1> transforms_;
  std::int64_t step_ns_ = kLongestStepNs;
};

}  // namespace scree
