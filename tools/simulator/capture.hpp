#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "scree/core/result.hpp"
#include "simulator/cloud.hpp"
#include "simulator/drive.hpp"

namespace scree {

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
