#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "scree/config/settings.hpp"
#include "scree/core/can_frame.hpp"
#include "scree/core/descriptor.hpp"
#include "scree/core/result.hpp"
#include "scree/drivers/encoder/bus_state.hpp"

namespace scree::encoder {

struct CanSocketCounts {
  std::uint64_t received = 0;      ///< handed to the caller, error frames too
  std::uint64_t malformed = 0;     ///< neither a classic nor an FD frame of the kernel
  std::uint64_t kernel_drops = 0;  ///< arrived while the socket's buffer was full
  std::uint64_t reopened = 0;      ///< after the interface was gone
};

/// A raw SocketCAN socket that listens, and keeps listening: through bus-off, through an interface
/// that goes down and comes up, and through an adapter that is unplugged and plugged in again under
/// the same name. Frames carry the kernel's time of arrival.
///
/// A thread's loop: poll descriptor() for reading, for at most kRetryNs; then receive() until there
/// is nothing, then retry(). A descriptor of -1 is one that poll() passes over.
class CanSocket {
public:
  static constexpr std::int64_t kRetryNs = 500'000'000;

  /// Listens for the encoder's identifier and for error frames. An interface that is there but
  /// down is no error: it may come up. One sentence where there is none of that name, it is no CAN
  /// interface or the kernel has no CAN.
  static Result<CanSocket> open(const EncoderSettings& settings);
  /// The same for all frames of an interface.
  static Result<CanSocket> open(const std::string& interface);

  /// How a socket is opened, and whether its interface is up.
  struct Device {
    std::function<Result<Descriptor>()> open;
    std::function<bool(const Descriptor&)> is_up;
  };
  static Result<CanSocket> open(Device device);

  /// The next frame that waits, or nothing. Never blocks.
  std::optional<CanFrame> receive();
  /// Opens the socket anew where the interface was gone, and looks whether it is up where it was
  /// down; both at most every kRetryNs. @param now_ns of any clock that runs steadily
  void retry(std::int64_t now_ns);

  int descriptor() const { return socket_.get(); }
  BusState state() const { return monitor_.state(); }
  const BusCounters& bus() const { return monitor_.counters(); }
  const CanSocketCounts& counts() const { return counts_; }

private:
  void failed(int error);

  Device device_;
  Descriptor socket_;
  BusMonitor monitor_;
  CanSocketCounts counts_;
  std::uint32_t last_drops_ = 0;  // the kernel's own counter, which wraps
  std::int64_t next_retry_ns_ = 0;
};

}  // namespace scree::encoder
