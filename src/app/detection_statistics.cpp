#include "detection_statistics.hpp"

namespace scree {
namespace {

latency_t summary(const LatencyHistogram& histogram) {
  const auto milliseconds = [](std::int64_t ns) { return static_cast<double>(ns) / 1e6; };
  return {static_cast<std::int64_t>(histogram.count()), milliseconds(histogram.quantile_ns(0.5)),
          milliseconds(histogram.quantile_ns(0.99)), milliseconds(histogram.max_ns())};
}

}  // namespace

void DetectionStatistics::record(std::int64_t latency_ns, std::int64_t detector_ns,
                                 const DetectionReport& report) {
  latency_.record(latency_ns);
  detector_.record(detector_ns);
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    if (report.stage_times[i] != kDidNotRun) stages_[i].record(report.stage_times[i]);
  }
  drops_ = report.drops;
  motion_ = report.motion;
  setup_ = report.setup;
}

void DetectionStatistics::fill(health_t& health) const {
  health.latency = summary(latency_);
  health.detector_time = summary(detector_);
  health.stages.clear();
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    if (stages_[i].count() == 0) continue;
    health.stages.emplace_back();
    health.stages.back().name = kStageNames[i];
    health.stages.back().time = summary(stages_[i]);
  }
  health.stages_size = static_cast<std::int32_t>(health.stages.size());
  const auto count = [](std::uint64_t value) { return static_cast<std::int64_t>(value); };
  health.points_refused = count(drops_.points_refused);
  health.edge_points_dropped = count(drops_.edge_points);
  health.obstacles_dropped = count(drops_.obstacles);
  health.map_points_dropped = count(drops_.map_points);
  health.tracks_dropped = count(drops_.tracks);
  health.sweeps_slipped = count(motion_.slips);
  health.heading_resets = count(motion_.heading_resets);
  health.position_deviation = motion_.position_deviation;
  health.yaw_deviation = motion_.yaw_deviation;
}

}  // namespace scree
