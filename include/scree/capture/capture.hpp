#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scree/core/result.hpp"

namespace scree {

/// What a folder of a capture may hold.
inline constexpr std::array<std::string_view, 8> kCaptureFiles = {
    "lidar.pcap", "lidar.pcapng", "lidar.lcm",  "imu.pcap",
    "imu.pcapng", "can.log",      "truth.json", "scree.toml"};

/// The lidar's file of a capture: the capture itself when it is a file, else lidar.pcap,
/// lidar.pcapng or lidar.lcm in its folder.
Result<std::filesystem::path> lidar_file(const std::filesystem::path& capture);

/// The IMU's file of a capture: the capture itself when it is a file, else imu.pcap or imu.pcapng
/// in its folder.
Result<std::filesystem::path> imu_file(const std::filesystem::path& capture);

/// The CAN log of a capture: the capture itself when it is a file, else can.log in its folder.
Result<std::filesystem::path> can_file(const std::filesystem::path& capture);

/// Recordings in a capture's folder that have other names, as the end of a sentence; empty: none.
std::string other_files(const std::filesystem::path& capture);

/// The program that packed a file, as "gzip", by its first bytes; empty: none that is known.
std::string_view packed_with(const std::filesystem::path& file);

/// What a file is that is neither a capture nor what packs one, by its first bytes, and what to do
/// with it, as a sentence; empty: nothing that is known.
std::string other_kind(const std::filesystem::path& file);

/// The configuration that belongs to a capture: `given` when not empty, else scree.toml in the
/// capture's folder when there is one. Nothing: the defaults.
std::optional<std::filesystem::path> settings_file(const std::filesystem::path& capture,
                                                   const std::filesystem::path& given);

}  // namespace scree
