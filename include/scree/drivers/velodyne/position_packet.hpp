#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "scree/drivers/velodyne/wire.hpp"

namespace scree::velodyne {

/// Whether the sensor's clock follows a pulse per second (63-9243 Rev. D, section 9.3.2).
enum class PpsStatus : std::uint8_t { absent, synchronizing, locked, error };
inline constexpr std::array<std::string_view, 4> kPpsNames = {"absent", "synchronizing", "locked",
                                                              "error"};

/// The GPS receiver's $GPRMC sentence, its checksum being right.
struct Gprmc {
  bool fix = false;                     ///< status A; with V the rest may be old
  std::optional<std::int64_t> utc_ns;   ///< since the UNIX epoch; needs time and date
  std::optional<double> latitude_deg;   ///< north positive
  std::optional<double> longitude_deg;  ///< east positive
};

struct PositionPacket {
  std::uint32_t timestamp_us = 0;  ///< past the hour, on the clock of the data packets
  std::optional<PpsStatus> pps;    ///< nothing where the byte is none of the known
  std::string_view sentence;       ///< as received, without line end; lies in the packet
  std::optional<Gprmc> gprmc;      ///< nothing where there is none, or its checksum is wrong
};

/// What is to be looked at where position packets come, but no data packets.
inline constexpr std::string_view kPositionAlone =
    "its position packets come, so power and cable are right: are its lasers off, does its motor "
    "turn, is lidar.port its data port?";

/// Nothing when the datagram is not 512 bytes long. Any bytes are safe.
std::optional<PositionPacket> parse_position_packet(Bytes datagram);

/// Reads one NMEA 0183 sentence, from $ to the checksum. Fields that are empty or make no sense are
/// left out; nothing when it is no RMC sentence or the checksum is wrong or missing.
std::optional<Gprmc> parse_gprmc(std::string_view sentence);

}  // namespace scree::velodyne
