#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "detection/setup_log.hpp"
#include "detection/waiting_sweeps.hpp"
#include "read/motion_capture.hpp"
#include "scree/terrain/setup_probe.hpp"

namespace scree::cli {

/// Holds a capture's settings against what its sensors say, without looking for obstacles.
class SettingsCheck {
public:
  /// Where IMU or encoder cannot be read the lidar is looked at alone: it is not for this to say
  /// so.
  SettingsCheck(const std::filesystem::path& capture, const std::filesystem::path& config,
                const Settings& settings, const HostSteps& steps);

  /// Before each packet.
  void play_until(std::int64_t arrival_ns);
  void add(const Sweep& sweep);
  /// At the end of the capture: what is wrong.
  std::vector<std::string> finish();

private:
  std::unique_ptr<SyncBuffer> sensors_;
  std::optional<MotionCapture> motion_;
  SetupProbe probe_;
  SetupLog log_;
  WaitingSweeps waiting_;
  std::int64_t now_ns_ = 0;
};

}  // namespace scree::cli
