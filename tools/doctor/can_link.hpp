#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "doctor/finding.hpp"

namespace scree {

/// A network interface of the CAN kind, as the kernel's netlink answers RTM_GETLINK.
struct CanLink {
  std::string kind;  ///< "can", "vcan", "slcan"; empty where the driver says none
  bool is_can = false, is_up = false;
  std::uint32_t bit_rate = 0;    ///< 0: none is set, or the kind has none
  std::uint32_t restart_ms = 0;  ///< after bus-off; 0: never by itself
};

/// Reads the answer, one RTM_NEWLINK message (linux/rtnetlink.h, linux/can/netlink.h). Any bytes
/// are safe; nothing where it is none.
std::optional<CanLink> parse_can_link(std::span<const std::uint8_t> answer);

/// What was heard on the interface.
struct CanTraffic {
  std::uint64_t wanted = 0;    ///< frames with the encoder's identifier
  std::uint64_t others = 0;    ///< with other ones
  std::uint32_t other_id = 0;  ///< the last of these
  std::string bus_advice;      ///< of the bus's state; empty where nothing is wrong
  double seconds = 0;
};

/// @param link nothing: there is no such interface
Finding check_can_link(const std::string& interface, const std::optional<CanLink>& link);
Finding check_can_traffic(const std::string& interface, std::int64_t can_id,
                          const CanTraffic& traffic);

}  // namespace scree
