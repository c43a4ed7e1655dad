#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <string_view>

#include "scree/core/queue_depth.hpp"
#include "sensor_status.hpp"

namespace scree {

/// What the daemon's readers and its detector have seen and done since the start, for health.
struct DaemonStatus {
  LidarStatus lidar;
  ImuStatus imu;
  EncoderStatus encoder;
  std::uint64_t samples_dropped = 0;  ///< the ring of IMU or encoder was full
  std::uint64_t samples_refused = 0;  ///< see SyncBuffer::gather()

  std::int64_t detector_loop_ns = 0;  ///< see DetectorWorker::last_loop_ns()
  std::uint64_t sweeps_not_covered = 0, lists_dropped = 0;

  struct Queue {
    std::string_view name;  ///< in health
    QueueFill fill;
  };
  boost::container::static_vector<Queue, 4> queues;
};

}  // namespace scree
