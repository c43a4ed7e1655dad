#pragma once

#include <cmath>
#include <memory>

#include "scree/config/settings.hpp"
#include "scree/sync/sync_buffer.hpp"

namespace scree {

/// The ring buffer for a robot's IMU and encoder, as they are mounted and delayed.
inline std::unique_ptr<SyncBuffer> sync_buffer_of(const Settings& settings) {
  const SampleDelays delays{.imu_ns = std::llround(settings.imu.delay * 1e9),
                            .wheel_ns = std::llround(settings.encoder.delay * 1e9)};
  return std::make_unique<SyncBuffer>(settings.imu.mount().rotation, delays);
}

}  // namespace scree
