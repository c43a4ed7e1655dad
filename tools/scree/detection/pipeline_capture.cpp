#include "detection/pipeline_capture.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <utility>

#include "commands.hpp"
#include "detection/setup_log.hpp"
#include "detection/waiting_sweeps.hpp"
#include "scree/app/memory_cap.hpp"
#include "scree/capture/capture.hpp"

namespace scree::cli {
namespace {

Pipeline make_pipeline(const Settings& settings, const std::filesystem::path& capture,
                       const std::filesystem::path& config) {
  const auto file = settings_file(capture, config).value_or(std::filesystem::path());
  auto pipeline = within_memory([&] { return Pipeline::make(settings, file); });
  if (!pipeline) throw Failure(pipeline.error().message);
  return *std::move(pipeline);
}

void warn_of_losses(Pipeline& pipeline, const WaitingSweeps& sweeps) {
  const Mapper& mapper = pipeline.mapper();
  warn("map", mapper.map().dropped(), "points found no room: raise memory.map_voxels");
  warn("map", mapper.slips(),
       "sweeps during which the wheel slipped; it was not believed (in all of them: encoder.scale "
       "is wrong, or its sign)");
  warn("tracks", pipeline.tracks_dropped(), "found no room: raise memory.obstacles");
  warn("IMU", pipeline.sensors().heading().corrections(),
       "turns of its yaw that its angular rate did not know of; they were not believed");
  warn("motion", pipeline.sensors().dropped(), "samples of IMU or encoder found no room");
  warn("motion", pipeline.sensors().late(),
       "samples of IMU or encoder were not newer than the one before, or no plausible numbers");
  warn("motion", sweeps.not_covered(),
       "sweeps went on without the samples of IMU or encoder that cover them: those came later "
       "than map.wait");
}

}  // namespace

void warn(std::string_view what, std::uint64_t count, std::string_view reason) {
  if (count > 0) fmt::print(stderr, "scree: {}: {} {}\n", what, count, reason);
}

PipelineCapture::PipelineCapture(const std::filesystem::path& capture,
                                 const std::filesystem::path& config)
    : settings_(capture_settings(capture, config)),
      steps_(find_host_steps(capture, settings_.lidar)),
      lidar_(capture, settings_, steps_),
      pipeline_(make_pipeline(settings_, capture, config)),
      motion_(capture, config, settings_, pipeline_.sensors(), steps_) {}

void PipelineCapture::play(const std::function<void(const Sweep&)>& process) {
  SetupLog setup;
  WaitingSweeps waiting(settings_.motion_wait(), pipeline_.sensors(), [&](const Sweep& sweep) {
    process(sweep);
    setup.add(pipeline_.setup());
  });
  std::int64_t now_ns = 0;
  const auto on_sweep = [&](Sweep& sweep) {
    if (!sweep.points.empty() && !sweep.is_standing) waiting.push(sweep, now_ns);
  };
  stream_.emplace(settings_.lidar, on_sweep, velodyne::LidarStream::OnPacket(),
                  settings_.detect.lists_per_turn);
  lidar_.play(*stream_, {}, [&](std::int64_t arrival_ns) {
    now_ns = arrival_ns;
    motion_.play_until(arrival_ns);
    waiting.process_ready(arrival_ns);
  });
  // Motion goes on until the last sweeps are covered, and no further: history is short.
  constexpr std::int64_t kStepNs = 10'000'000;
  const std::int64_t end_ns = now_ns + static_cast<std::int64_t>(settings_.motion_wait() * 1e9);
  for (; waiting.has_any() && now_ns < end_ns; now_ns += kStepNs) {
    motion_.play_until(now_ns);
    waiting.process_ready(now_ns);
  }
  waiting.process_all();
  motion_.finish();
  report_capture(lidar_, *stream_);
  motion_.report(lidar_.span());
  say(steps_);
  for (const std::string& mistake : setup.sentences()) fmt::print(stderr, "scree: {}\n", mistake);
  warn_of_losses(pipeline_, waiting);
}

}  // namespace scree::cli
