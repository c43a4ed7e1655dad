#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace scree::velodyne {

/// Why a datagram on the data port was not used.
enum class Refusal : std::uint8_t {
  none,
  size,           ///< not 1206 bytes
  flags,          ///< a block does not begin with FF EE
  product,        ///< of a model that is not known
  return_mode,    ///< neither strongest, last nor dual
  azimuth,        ///< above 360 degrees
  timestamp,      ///< more than a second past the hour
  timing,         ///< product byte 0x21 and not the packet rate of a VLP-16: an HDL-32E
  duplicate,      ///< the time stamp of the packet before it
  late,           ///< out of order: older than the packet before it
  second_sensor,  ///< between those of another sensor with the same address
  puck_hires,     ///< of that model, which is not the configured one
  vlp16,          ///< the same
  unsupported     ///< of a model that is not supported
};
inline constexpr std::size_t kRefusals = 14;

/// For counters in tables and JSON.
inline constexpr std::array<std::string_view, kRefusals> kRefusalNames = {
    "none",   "size",      "flags", "product",       "return_mode", "azimuth", "timestamp",
    "timing", "duplicate", "late",  "second_sensor", "puck_hires",  "vlp16",   "unsupported"};

/// For people.
inline constexpr std::array<std::string_view, kRefusals> kRefusalReasons = {
    "accepted",
    "not 1206 bytes long",
    "a block does not begin with FF EE",
    "product byte of no model that is known",
    "return mode byte is neither strongest, last nor dual",
    "azimuth above 360 degrees",
    "time stamp more than a second past the hour",
    "packet rate of another sensor (HDL-32E)",
    "duplicate",
    "out of order",
    "of a second sensor with the same address: give each sensor an address of its own",
    "of a Puck Hi-Res: set lidar.model = \"puck_hires\"",
    "of a VLP-16 or Puck LITE: set lidar.model = \"vlp16\"",
    "of a VLP-32C, VLS-128 or another model of Velodyne that is not supported"};

}  // namespace scree::velodyne
