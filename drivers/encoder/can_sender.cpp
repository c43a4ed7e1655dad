#include "scree/drivers/encoder/can_sender.hpp"

#include <linux/can.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

#include "can_device.hpp"

namespace scree::encoder {

Result<CanSender> CanSender::open(const std::string& interface) {
  auto socket = open_for_sending(interface);
  if (!socket) return tl::make_unexpected(socket.error());
  return CanSender(std::move(*socket));
}

int CanSender::send(const CanFrame& frame) {
  // A classic frame is the beginning of an FD one.
  canfd_frame wire{};
  wire.can_id = frame.id | (frame.is_extended ? CAN_EFF_FLAG : 0) |
                (frame.is_error ? CAN_ERR_FLAG : 0) | (frame.is_remote ? CAN_RTR_FLAG : 0);
  wire.len = frame.size;
  std::ranges::copy(frame.payload(), wire.data);
  const std::size_t size = frame.size > CAN_MAX_DLEN ? CANFD_MTU : CAN_MTU;
  const ssize_t sent = ::send(socket_.get(), &wire, size, MSG_DONTWAIT | MSG_NOSIGNAL);
  return sent < 0 ? errno : 0;
}

}  // namespace scree::encoder
