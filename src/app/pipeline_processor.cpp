#include "pipeline_processor.hpp"

namespace scree {

PipelineProcessor::PipelineProcessor(Pipeline& pipeline, const TrackingSettings& tracking)
    : pipeline_(pipeline) {
  set_tracking(tracking);
}

const ObstacleList* PipelineProcessor::operator()(const Sweep& sweep, DetectionReport& report) {
  pipeline_.set_tracking(tracking_.get());
  const ObstacleList& list = pipeline_.process(sweep);
  add_drops();
  report = {drops_, motion_report(), pipeline_.setup(), pipeline_.stage_times(), pipeline_.grid()};
  return pipeline_.has_looked() ? &list : nullptr;
}

void PipelineProcessor::add_drops() {
  const StageCounts counts = pipeline_.counts();
  drops_.points += counts.dropped;
  drops_.points_refused += counts.refused;
  drops_.edge_points += counts.candidates_dropped;
  drops_.obstacles += counts.obstacles_dropped;
  // These two count since the start themselves.
  drops_.map_points = pipeline_.mapper().map().dropped();
  drops_.tracks = pipeline_.tracks_dropped();
}

MotionReport PipelineProcessor::motion_report() const {
  MotionReport report;
  report.slips = pipeline_.mapper().slips();
  report.heading_resets = pipeline_.sensors().heading().corrections();
  if (!pipeline_.uses_map()) return report;
  const PoseFilter& filter = pipeline_.mapper().filter();
  report.position_deviation = filter.position_deviation().head<2>().maxCoeff();
  report.yaw_deviation = filter.rotation_deviation().z();
  return report;
}

}  // namespace scree
