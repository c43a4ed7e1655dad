#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "scree/core/descriptor.hpp"
#include "scree/core/result.hpp"

namespace scree::xsens {

/// What one read from the port gave.
struct ReceivedBytes {
  std::span<const std::uint8_t> bytes;  ///< in the buffer given to receive()
  std::int64_t arrival_ns = 0;          ///< when the read returned, host time
};

/// A serial port: raw bytes, 8 data bits, no parity, one stop bit, no flow control, for this
/// process alone.
class SerialPort {
public:
  /// @param device may be a symbolic link, as those in /dev/serial/by-id
  static Result<SerialPort> open(const std::string& device, int baud);

  /// Any bit rate that the driver can do within 3 %. Bytes that wait are thrown away.
  Result<void> set_baud(int baud);

  enum class Reading : std::uint8_t { bytes, nothing, lost };
  /// Bytes that wait, or nothing, or that the port has gone. Never blocks; poll descriptor().
  Reading receive(std::span<std::uint8_t> buffer, ReceivedBytes& received);

  /// Whether all of it was taken; the kernel holds some thousand bytes.
  bool send(std::span<const std::uint8_t> bytes);

  int descriptor() const { return port_.get(); }

private:
  std::string device_;
  Descriptor port_;
};

}  // namespace scree::xsens
