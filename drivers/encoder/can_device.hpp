#pragma once

#include <linux/can.h>

#include <optional>
#include <string>

#include "scree/drivers/encoder/can_socket.hpp"

namespace scree::encoder {

struct CanId {
  std::uint32_t id;
  bool is_extended;
  std::uint32_t mask = CAN_EFF_MASK;  ///< the bits that must agree
};

/// The real interface.
/// @param only the identifier to listen for, beside error frames; without it all are heard
CanSocket::Device can_device(const std::string& interface, std::optional<CanId> only);

/// A socket that only sends on an interface.
Result<Descriptor> open_for_sending(const std::string& interface);

}  // namespace scree::encoder
