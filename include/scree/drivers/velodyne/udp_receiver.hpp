#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "scree/core/descriptor.hpp"
#include "scree/core/result.hpp"

namespace scree {

/// What open() below makes of its addresses, in host byte order, or the sentence that it gives; 0
/// is any. Nothing is opened.
Result<std::uint32_t> local_address(const std::string& text);
Result<std::uint32_t> sender_address(const std::string& text);
/// Whether this computer has an address that open() would listen on. The port is not asked for.
Result<void> check_interface(const std::string& address);

/// A datagram as the kernel hands it over.
struct ReceivedDatagram {
  std::span<const std::uint8_t> bytes;  ///< in the buffer given to receive()
  std::int64_t arrival_ns = 0;          ///< when the kernel took it in, wall clock
  std::uint32_t sender = 0;             ///< IPv4 address, host byte order
  std::uint16_t sender_port = 0;
  bool truncated = false;  ///< it was longer than the buffer; the rest is lost
};

/// Since the socket was opened.
struct UdpCounts {
  std::uint64_t received = 0;      ///< handed to the caller
  std::uint64_t foreign = 0;       ///< from another sender than the accepted one
  std::uint64_t truncated = 0;     ///< received, but longer than the buffer
  std::uint64_t kernel_drops = 0;  ///< arrived while the socket's buffer was full
  std::uint64_t errors = 0;        ///< failed reads
};

/// A UDP socket that listens for a sensor's datagrams.
class UdpReceiver {
public:
  /// @param address local IPv4 address; 0.0.0.0 listens on every interface and is the only one that
  ///        also takes datagrams sent to a broadcast address, as the VLP-16 sends them by default
  /// @param port 0 lets the kernel choose
  /// @param sender IPv4 address that datagrams must come from; empty accepts any
  static Result<UdpReceiver> open(const std::string& address, int port, const std::string& sender);

  /// The next datagram that waits, or nothing. Never blocks; poll descriptor() for reading.
  std::optional<ReceivedDatagram> receive(std::span<std::uint8_t> buffer);

  int descriptor() const { return socket_.get(); }
  int port() const { return port_; }
  /// What the kernel gave for datagrams that wait, in bytes with the kernel's own overhead.
  int buffer_bytes() const { return buffer_bytes_; }
  const UdpCounts& counts() const { return counts_; }

private:
  Descriptor socket_;
  int port_ = 0;
  int buffer_bytes_ = 0;
  std::uint32_t accepted_sender_ = 0;  // host byte order, 0 accepts any
  std::uint32_t last_drops_ = 0;       // the kernel's own counter, which wraps
  UdpCounts counts_;
};

}  // namespace scree
