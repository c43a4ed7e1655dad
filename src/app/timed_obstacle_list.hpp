#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "scree/app/detection_report.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/obstacle_grid.hpp"
#include "spsc_pool.hpp"

namespace scree {

/// A list, and the grid beside it, on their way from the detector to the publisher.
struct TimedObstacleList {
  explicit TimedObstacleList(std::size_t max_obstacles) : list(max_obstacles) {}

  /// Copies a list, as far as there is room, and what is reported beside it; allocates nothing.
  void copy_from(const ObstacleList& from, const DetectionReport& with) {
    list.stamp_ns = from.stamp_ns;
    list.pose = from.pose;
    list.obstacles.resize(std::min(from.obstacles.size(), list.obstacles.capacity()));
    std::copy_n(from.obstacles.begin(), list.obstacles.size(), list.obstacles.begin());
    report = with;
    report.grid = nullptr;  // what it points to is the detector's
    grid.clear();
    if (with.grid != nullptr) grid.copy_from(*with.grid);
  }

  ObstacleList list;
  ObstacleGrid grid;             ///< empty: without one
  std::int64_t arrival_ns = 0;   ///< when the sweep's last packet came, monotonic clock
  std::int64_t detector_ns = 0;  ///< how long the detector worked
  DetectionReport report;
};
using ObstacleListPool = SpscPool<TimedObstacleList>;

}  // namespace scree
