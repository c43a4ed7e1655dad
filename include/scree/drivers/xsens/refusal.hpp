#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace scree::xsens {

/// Why bytes of an MTi were not used: a message, or one item of a message.
enum class Refusal : std::uint8_t {
  none,
  checksum,    ///< message: its bytes do not add up; so do false preambles
  length,      ///< message: longer than any that there is
  truncated,   ///< item: goes on behind the end of its message; the rest is refused with it
  size,        ///< item: not as long as its id says
  not_finite,  ///< item: a number is infinite or none
  not_unit,    ///< item: a quaternion or matrix that is no rotation
  empty,       ///< message: MTData2 without any item that could be used
  duplicate,   ///< message: the packet counter or sample time of the message before it
  late,        ///< message: older than the message before it
  implausible  ///< message: garbled, for no IMU measures its rate or acceleration
};
inline constexpr std::size_t kRefusals = 11;
using RefusalCounts = std::array<std::uint64_t, kRefusals>;  ///< by Refusal; [none] stays 0

/// For counters in tables and JSON.
inline constexpr std::array<std::string_view, kRefusals> kRefusalNames = {
    "none",     "checksum", "length",    "truncated", "size",       "not_finite",
    "not_unit", "empty",    "duplicate", "late",      "implausible"};

/// For people.
inline constexpr std::array<std::string_view, kRefusals> kRefusalReasons = {
    "accepted",
    "wrong checksum",
    "longer than 2048 bytes",
    "an item goes on behind the end of its message",
    "an item has the wrong size",
    "an item holds a number that is not finite",
    "an orientation is no rotation",
    "no item that could be read",
    "duplicate",
    "out of order",
    "a rate or an acceleration that no IMU measures"};

}  // namespace scree::xsens
