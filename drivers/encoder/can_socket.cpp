#include "scree/drivers/encoder/can_socket.hpp"

#include <linux/can.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

#include "can_device.hpp"
#include "scree/core/socket_message.hpp"

namespace scree::encoder {
namespace {

/// A frame as the kernel has it; nothing where it is none.
std::optional<CanFrame> frame_of(std::span<const std::uint8_t, sizeof(canfd_frame)> bytes,
                                 std::size_t size) {
  canfd_frame wire;
  std::memcpy(&wire, bytes.data(), sizeof wire);
  const std::size_t most = size == CANFD_MTU ? CANFD_MAX_DLEN : CAN_MAX_DLEN;
  if ((size != CAN_MTU && size != CANFD_MTU) || wire.len > most) return std::nullopt;
  CanFrame frame;
  frame.is_error = (wire.can_id & CAN_ERR_FLAG) != 0;
  frame.is_remote = (wire.can_id & CAN_RTR_FLAG) != 0;
  frame.is_extended = !frame.is_error && (wire.can_id & CAN_EFF_FLAG) != 0;
  frame.id = wire.can_id & (frame.is_extended || frame.is_error ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.size = wire.len;
  std::copy_n(wire.data, frame.size, frame.data.begin());
  return frame;
}

}  // namespace

Result<CanSocket> CanSocket::open(const EncoderSettings& settings) {
  const CanId id{static_cast<std::uint32_t>(settings.can_id), settings.has_extended_id(),
                 settings.id_mask()};
  return open(can_device(settings.interface, id));
}

Result<CanSocket> CanSocket::open(const std::string& interface) {
  return open(can_device(interface, std::nullopt));
}

Result<CanSocket> CanSocket::open(Device device) {
  CanSocket socket;
  socket.device_ = std::move(device);
  auto descriptor = socket.device_.open();
  if (!descriptor) return tl::make_unexpected(descriptor.error());
  socket.socket_ = std::move(*descriptor);
  return socket;
}

std::optional<CanFrame> CanSocket::receive() {
  while (socket_.is_open()) {
    std::array<std::uint8_t, sizeof(canfd_frame)> bytes{};
    const std::uint32_t drops_before = last_drops_;
    const SocketMessage message = receive_message(socket_.get(), bytes, last_drops_);
    if (message.size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return std::nullopt;
    if (message.size <= 0) {
      failed(message.size < 0 ? errno : ENODEV);
      return std::nullopt;
    }
    counts_.kernel_drops += last_drops_ - drops_before;
    auto frame = frame_of(bytes, static_cast<std::size_t>(message.size));
    if (!frame || message.is_truncated) {
      ++counts_.malformed;
      continue;
    }
    frame->t_ns = message.arrival_ns;
    monitor_.take(*frame);
    ++counts_.received;
    return frame;
  }
  return std::nullopt;
}

void CanSocket::failed(int error) {
  monitor_.failed(error);
  next_retry_ns_ = 0;
  // A socket lives on while its interface is down, and dies with it.
  if (error == ENETDOWN) return;
  socket_ = Descriptor();
  last_drops_ = 0;
}

void CanSocket::retry(std::int64_t now_ns) {
  const bool is_down = state() == BusState::down;
  if ((socket_.is_open() && !is_down) || now_ns < next_retry_ns_) return;
  next_retry_ns_ = now_ns + kRetryNs;
  if (is_down) {
    if (device_.is_up(socket_)) monitor_.is_up();
    return;
  }
  auto socket = device_.open();
  if (!socket) return;
  socket_ = std::move(*socket);
  ++counts_.reopened;
  monitor_.is_up();
}

}  // namespace scree::encoder
