#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "scree/detect/tracker.hpp"

namespace scree {

/// A tracker without a judge, and obstacles for it: lists every 0.1 s.
class TrackerTest : public testing::Test {
protected:
  static constexpr std::size_t kMost = 16;
  static constexpr std::int64_t kStart = 1'598'612'523'000'000'000, kList = 100'000'000;

  TrackingSettings settings_{.reach = 100};
  Tracker tracker_{settings_, kMost};
  FixedVector<Obstacle> list_{kMost};
  Occupancy occupancy_ = Occupancy::occupied;
  Eigen::Vector3d robot_ = Eigen::Vector3d::Zero();
  std::int64_t now_ns_ = kStart;
  float turns_ = 1;  // from list to list

  static Obstacle at(double x, double y, float confidence = 0.9F) {
    Obstacle obstacle;
    obstacle.center = {x, y, 0.2};
    obstacle.extent = {0.6, 0.4, 0.4};
    obstacle.yaw = 0.3;
    obstacle.height = 0.4;
    obstacle.confidence = confidence;
    obstacle.points = 50;
    return obstacle;
  }

  static Obstacle hole_at(double x, double y, float confidence = 0.9F) {
    Obstacle obstacle = at(x, y, confidence);
    obstacle.kind = ObstacleKind::negative;
    obstacle.height = -0.4;
    obstacle.center.z() = -0.2;
    return obstacle;
  }

  const FixedVector<Obstacle>& update(const std::vector<Obstacle>& found, int times = 1) {
    for (int i = 0; i < times; ++i) {
      tracker_.update(
          now_ns_ += std::llround(turns_ * kList), robot_, found,
          [this](const Eigen::Vector3d&) { return occupancy_; }, list_, turns_);
    }
    return list_;
  }
  /// Lists until the list is as long as asked for; 100 at most.
  int updates_until(std::size_t size, const std::vector<Obstacle>& found) {
    for (int i = 1; i < 100; ++i) {
      if (update(found).size() == size) return i;
    }
    return 100;
  }
};

}  // namespace scree
