#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "scree/core/descriptor.hpp"

namespace scree::cli {

/// A socket that sends to one port, and hears from the kernel when nobody listens there.
class UdpTarget {
public:
  /// Throws Failure, or CLI::ValidationError for what is no IPv4 address.
  UdpTarget(const std::string& address, int port);

  /// Throws Failure.
  void send(std::span<const std::uint8_t> bytes);

  const std::string& name() const { return name_; }
  std::uint64_t sent() const { return sent_; }
  /// The kernel tells of a datagram that nobody took only at the next one, which it does not send.
  bool is_deaf() const { return refused_ >= 25 && refused_ + 1 >= sent_; }

private:
  std::string name_;
  Descriptor socket_;
  std::uint64_t sent_ = 0, refused_ = 0;
};

}  // namespace scree::cli
