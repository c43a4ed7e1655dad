#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace scree::velodyne {

/// Why a datagram on the data port was not used.
enum class Refusal : std::uint8_t {
  none,
  size,          ///< not 1206 bytes
  flags,         ///< a block does not begin with FF EE
  product,       ///< of another model than the configured one
  return_mode,   ///< neither strongest, last nor dual
  azimuth,       ///< above 360 degrees
  timestamp,     ///< more than a second past the hour
  timing,        ///< product byte 0x21 and not the packet rate of a VLP-16: an HDL-32E
  duplicate,     ///< the time stamp of the packet before it
  late,          ///< out of order: older than the packet before it
  second_sensor  ///< between those of another sensor with the same address
};
inline constexpr std::size_t kRefusals = 11;

/// For counters in tables and JSON.
inline constexpr std::array<std::string_view, kRefusals> kRefusalNames = {
    "none",      "size",   "flags",     "product", "return_mode",  "azimuth",
    "timestamp", "timing", "duplicate", "late",    "second_sensor"};

/// For people.
inline constexpr std::array<std::string_view, kRefusals> kRefusalReasons = {
    "accepted",
    "not 1206 bytes long",
    "a block does not begin with FF EE",
    "product byte of another model than lidar.model",
    "return mode byte is neither strongest, last nor dual",
    "azimuth above 360 degrees",
    "time stamp more than a second past the hour",
    "packet rate of another sensor (HDL-32E)",
    "duplicate",
    "out of order",
    "of a second sensor with the same address: give each sensor an address of its own"};

}  // namespace scree::velodyne
