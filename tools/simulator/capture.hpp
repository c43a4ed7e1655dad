#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "scree/core/result.hpp"
#include "simulator/cloud.hpp"

namespace scree {

struct CaptureSettings {
  std::uint64_t seed = 1;
  double seconds = 3;   ///< rounded to whole turns, at least one
  double rate_hz = 10;  ///< turns a second, 5 to 20
  bool dual = false;    ///< dual returns instead of the strongest
};

/// Writes a capture of a VLP-16 at rest on a terrain of this seed: lidar.pcap, scree.toml and
/// truth.json (CONTRACT.md). `base` stands level at the origin of the terrain's frame. The same
/// settings give the same bytes. Fails when a file cannot be written.
/// @param progress called with the share done, in per mille
Result<void> write_capture(const std::filesystem::path& folder, const CaptureSettings& settings,
                           const std::function<void(std::size_t)>& progress);

/// Writes one reconstructed cloud, and its truth beside it (CLOUD.pcd, CLOUD.truth.json).
/// @param terrain settings of it: by default like the paper's
Result<void> write_cloud(const std::filesystem::path& file, const CloudSettings& settings,
                         std::uint64_t seed, const TerrainSettings& terrain = {});

}  // namespace scree
