#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "scree/core/can_frame.hpp"

namespace scree::encoder {

/// How the bus is, as far as this computer's controller can tell.
enum class BusState : std::uint8_t {
  silent,   ///< open, and nothing has been heard yet
  active,   ///< frames arrive
  warning,  ///< more than 96 errors counted: bad cable, missing terminator, other bit rate
  passive,  ///< more than 127: the controller no longer reports errors to the others
  bus_off,  ///< more than 255 when sending: the controller left the bus until it is restarted
  down,     ///< the interface is not up
  absent    ///< there is no such interface: unplugged
};
inline constexpr std::size_t kBusStates = 7;

/// For tables and JSON.
inline constexpr std::array<std::string_view, kBusStates> kBusStateNames = {
    "silent", "active", "warning", "passive", "bus_off", "down", "absent"};
/// What a person can do about it; empty where nothing is wrong.
inline constexpr std::array<std::string_view, kBusStates> kBusStateAdvice = {
    "nothing is heard: is the device on, and the bit rate right?",
    "",
    "many errors on the bus: look at cable, terminators and bit rate",
    "very many errors on the bus: look at cable, terminators and bit rate",
    "the controller left the bus: set restart-ms, or `ip link set IF type can restart`",
    "the interface is down: `ip link set IF up type can bitrate ...`",
    "there is no such interface: is the adapter plugged in?"};

struct BusCounters {
  std::uint64_t frames = 0;        ///< data and remote frames
  std::uint64_t error_frames = 0;  ///< all reports of errors; these are some of them:
  std::uint64_t overflows = 0;     ///< the controller lost frames because the host was slow
  std::uint64_t lost_arbitrations = 0, protocol_errors = 0, missing_acknowledges = 0;
  std::uint64_t bus_off = 0, restarts = 0;
  std::uint64_t downs = 0, removals = 0;  ///< of the interface
};

/// Follows the state of the bus through the frames and error frames (linux/can/error.h) and the
/// socket's errors.
class BusMonitor {
public:
  /// Any frame that was received, whatever its identifier.
  void take(const CanFrame& frame);
  /// A read failed so (errno): ENETDOWN, or anything else, after which the socket is of no use.
  void failed(int error);
  /// The interface is there and up.
  void is_up();

  BusState state() const { return state_; }
  const BusCounters& counters() const { return counters_; }

private:
  void take_error(const CanFrame& frame);
  void take_controller(std::uint8_t problem);

  BusState state_ = BusState::silent;
  BusCounters counters_;
};

}  // namespace scree::encoder
