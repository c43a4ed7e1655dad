#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>

#include "read/lidar_capture.hpp"
#include "read/motion_capture.hpp"
#include "scree/app/pipeline.hpp"

namespace scree::cli {

/// Says on stderr that so many of something were left out, and why; nothing of none.
void warn(std::string_view what, std::uint64_t count, std::string_view reason);

/// A capture with a pipeline to play it through, in one thread.
class PipelineCapture {
public:
  /// @param config empty for the capture's own
  /// Throws Failure.
  PipelineCapture(const std::filesystem::path& capture, const std::filesystem::path& config);

  const Settings& settings() const { return settings_; }
  Pipeline& pipeline() { return pipeline_; }
  /// What has come of the lidar so far. @pre play() was called
  const velodyne::LidarStream& lidar() const { return *stream_; }
  const MotionCapture& motion() const { return motion_; }
  /// What the lidar's file holds. @pre play() has ended
  TimeSpan span() const { return lidar_.span(); }

  /// Plays all of it as the daemon would hear it, then says on stderr what was refused or lost.
  /// Throws Failure when no packet of the lidar was accepted.
  /// @param process gets each sweep in which the lidar had returns and turned, and its parts where
  /// detect.lists_per_turn asks for them, when
  ///   the samples of IMU and encoder that cover it have come, or it has waited for them for
  ///   map.wait
  void play(const std::function<void(const Sweep&)>& process);

private:
  Settings settings_;
  HostSteps steps_;
  LidarCapture lidar_;
  Pipeline pipeline_;
  MotionCapture motion_;
  std::optional<velodyne::LidarStream> stream_;
};

}  // namespace scree::cli
