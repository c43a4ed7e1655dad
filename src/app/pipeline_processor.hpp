#pragma once

#include "scree/app/detection_report.hpp"
#include "scree/app/pipeline.hpp"
#include "triple_buffer.hpp"

namespace scree {

/// Runs a pipeline as the daemon's SweepProcessor and sums up what it dropped.
class PipelineProcessor {
public:
  /// Keeps a reference to the pipeline.
  PipelineProcessor(Pipeline& pipeline, const TrackingSettings& tracking);

  const ObstacleList* operator()(const Sweep& sweep, DetectionReport& report);
  /// Takes effect from the next sweep on. One thread may call it beside the processing one.
  void set_tracking(const TrackingSettings& settings) { tracking_.put(settings); }

private:
  void add_drops();
  MotionReport motion_report() const;

  Pipeline& pipeline_;
  TripleBuffer<TrackingSettings> tracking_;
  DropCounts drops_;
};

}  // namespace scree
