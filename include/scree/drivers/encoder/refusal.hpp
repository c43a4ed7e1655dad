#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace scree::encoder {

/// Why a frame was not used.
enum class Refusal : std::uint8_t {
  none,
  error_frame,  ///< the controller's report of an error on the bus
  remote,       ///< asks for the signal and does not hold it
  size,         ///< ends before the signal does
  time,         ///< its time stamp is that of the frame before it, or earlier
  implausible,  ///< no wheel gets there in that time
  frozen,       ///< unchanged from one frame to the next on a moving robot
  unavailable   ///< a value that stands for none
};
inline constexpr std::size_t kRefusals = 8;

/// For counters in tables and JSON.
inline constexpr std::array<std::string_view, kRefusals> kRefusalNames = {
    "none", "error_frame", "remote", "size", "time", "implausible", "frozen", "unavailable"};

/// For people.
inline constexpr std::array<std::string_view, kRefusals> kRefusalReasons = {
    "accepted",
    "error frame",
    "remote frame, holds no data",
    "frame is shorter than the signal",
    "time stamp repeats or goes back",
    "faster than encoder.max_speed or max_acceleration",
    "stopped changing faster than a robot can brake",
    "the signal says that it is not available (VAL_ or range of the DBC file)"};

}  // namespace scree::encoder
