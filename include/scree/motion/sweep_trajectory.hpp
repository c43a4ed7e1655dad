#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// Where `base` was during a sweep, in `base` at the sweep's end, in equal steps of time.
class SweepTrajectory {
public:
  static constexpr std::int64_t kLongestStepNs = 5'000'000;
  static constexpr std::size_t kMaxSteps = 64;  ///< over the 0.22 s of the longest sweep

  struct Transform {
    Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
    Eigen::Vector3f translation = Eigen::Vector3f::Zero();  ///< metres
  };

  /// Standing still.
  SweepTrajectory() : transforms_(kMaxSteps + 1) { transforms_.push_back({}); }
  void start(std::int64_t step_ns) {
    transforms_.clear();
    step_ns_ = step_ns;
  }
  /// Takes one instant after the other, from the end backwards. False when full.
  bool push_back(const Transform& transform) { return transforms_.push_back(transform); }
  /// @param before_end_ns not below zero; before the trajectory's begin its first transform answers
  Transform at(std::int64_t before_end_ns) const;

private:
  FixedVector<Transform> transforms_;
  std::int64_t step_ns_ = kLongestStepNs;
};

}  // namespace scree
