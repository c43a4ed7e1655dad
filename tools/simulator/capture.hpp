#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "scree/core/result.hpp"
#include "simulator/cloud.hpp"
#include "simulator/faults.hpp"
#include "simulator/scene.hpp"

namespace scree {

struct CaptureSettings {
  std::uint64_t seed = 1;
  Scene scene = Scene::mixed;
  double seconds = 20;       ///< rounded to whole turns, at least one
  double speed = 0;          ///< mean while driving, m/s; 0: drawn from 0.4 to 1.6
  bool reverse = false;      ///< drives backwards for a stretch
  bool at_rest = false;      ///< the robot stands level at the origin, the ground is level there
  double rate_hz = 10;       ///< turns of the lidar a second, 5 to 20
  bool dual = false;         ///< dual returns instead of the strongest
  bool pps = false;          ///< the lidar's clock is locked to GPS; else it runs free
  double imu_rate_hz = 100;  ///< 100 to 400
  bool imu_bursts = false;   ///< a USB adapter hands the IMU's bytes on every 16 ms only
  double cell = 0.02;        ///< of the terrain's raster, metres
  double margin = 28;        ///< of terrain beyond the way, metres
  Faults faults;
};

/// Writes a capture of a robot that drives over a terrain of this seed: lidar.pcap, imu.pcap,
/// can.log, scree.toml and truth.json. The same settings give the same bytes. Fails
/// when a file cannot be written.
/// @param progress called with the share done, in per mille
Result<void> write_capture(const std::filesystem::path& folder, const CaptureSettings& settings,
                           const std::function<void(std::size_t)>& progress);

/// Writes one reconstructed cloud, and its truth beside it (CLOUD.pcd, CLOUD.truth.json).
/// @param terrain settings of it: by default like the paper's
Result<void> write_cloud(const std::filesystem::path& file, const CloudSettings& settings,
                         std::uint64_t seed, const TerrainSettings& terrain = {});

}  // namespace scree
