#pragma once

#include <string>

#include "scree/core/can_frame.hpp"
#include "scree/core/descriptor.hpp"
#include "scree/core/result.hpp"

namespace scree::encoder {

/// Sends frames on a SocketCAN interface.
class CanSender {
public:
  /// One sentence where there is no such interface, or no CAN.
  static Result<CanSender> open(const std::string& interface);
  /// @param socket sends each message as one frame
  explicit CanSender(Descriptor socket) : socket_(std::move(socket)) {}

  /// Never blocks. @return 0, or errno: ENOBUFS while the interface's queue is full, ENETDOWN ...
  int send(const CanFrame& frame);

private:
  Descriptor socket_;
};

}  // namespace scree::encoder
