#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <span>

#include "scree/core/nanoseconds.hpp"

namespace scree {

/// A message of a socket, and what the kernel says of it beside its bytes.
struct SocketMessage {
  ssize_t size = 0;  ///< below zero: there is none, errno says why
  bool is_truncated = false;
  std::int64_t arrival_ns = 0;  ///< host time when it came in; SO_TIMESTAMPNS must be on
  sockaddr_in sender{};         ///< of a UDP datagram
};

/// Receives the next message. `drops` follows the kernel's count, which wraps at 2^32, of messages
/// that found the socket's buffer full (SO_RXQ_OVFL must be on); the kernel tells of it only after
/// the first one.
inline SocketMessage receive_message(int socket, std::span<std::uint8_t> buffer,
                                     std::uint32_t& drops) {
  SocketMessage received;
  iovec part{buffer.data(), buffer.size()};
  alignas(cmsghdr) std::uint8_t control[128];
  msghdr message{};
  do {
    message.msg_name = &received.sender;
    message.msg_namelen = sizeof received.sender;
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    received.size = recvmsg(socket, &message, 0);
  } while (received.size < 0 && errno == EINTR);
  if (received.size < 0) return received;
  received.is_truncated = (message.msg_flags & MSG_TRUNC) != 0;
  for (cmsghdr* item = CMSG_FIRSTHDR(&message); item != nullptr;
       item = CMSG_NXTHDR(&message, item)) {
    if (item->cmsg_level != SOL_SOCKET) continue;
    if (item->cmsg_type == SCM_TIMESTAMPNS) {
      timespec arrival;
      std::memcpy(&arrival, CMSG_DATA(item), sizeof arrival);
      received.arrival_ns = to_ns(arrival);
    } else if (item->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&drops, CMSG_DATA(item), sizeof drops);
    }
  }
  return received;
}

}  // namespace scree
