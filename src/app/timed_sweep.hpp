#pragma once

#include <cstdint>

#include "scree/core/sweep.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"
#include "spsc_pool.hpp"

namespace scree {

/// A sweep on its way from the lidar's reader to the detector.
struct TimedSweep {
  Sweep sweep{velodyne::kSweepCapacity};
  std::int64_t arrival_ns = 0;  ///< when the packet that completed it came, monotonic clock
};
using SweepPool = SpscPool<TimedSweep>;

}  // namespace scree
