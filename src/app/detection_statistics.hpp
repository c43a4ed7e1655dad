#pragma once

#include <array>
#include <cstdint>
#include <scree/health_t.hpp>

#include "scree/app/detection_report.hpp"
#include "scree/core/latency_histogram.hpp"

namespace scree {

/// Sums up for health how long detection takes, and what found no room. One thread may use it.
class DetectionStatistics {
public:
  /// A list was published.
  /// @param latency_ns from its sweep's last packet
  /// @param detector_ns of it in the detector
  void record(std::int64_t latency_ns, std::int64_t detector_ns, const DetectionReport& report);

  /// Fills in the latencies and what the detector dropped, but for points_dropped.
  void fill(health_t& health) const;
  /// What the detector has dropped up to now.
  const DropCounts& drops() const { return drops_; }
  const MotionReport& motion() const { return motion_; }
  const SetupReport& setup() const { return setup_; }

private:
  LatencyHistogram latency_, detector_;
  std::array<LatencyHistogram, kStageNames.size()> stages_;
  DropCounts drops_;
  MotionReport motion_;
  SetupReport setup_;
};

}  // namespace scree
