#include "scree/drivers/velodyne/udp_receiver.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "scree/core/socket_message.hpp"

namespace scree {
namespace {

// Two seconds of a VLP-16 with dual returns: 1508 packets a second (63-9243 Rev. D), each of which
// takes 2304 bytes in the kernel.
constexpr int kWantedBuffer = 8 << 20;

std::string reason_of(int error, const std::string& address, int port) {
  const std::string where = address + ":" + std::to_string(port);
  switch (error) {
    case EADDRINUSE:
      return "UDP port " + std::to_string(port) +
             " is in use by another program (another screed? `ss -ulnp` lists them)";
    case EADDRNOTAVAIL:
      return "cannot listen on " + where + ": no interface of this computer has that address";
    case EACCES:
      return "cannot listen on " + where + ": ports below 1024 need the right CAP_NET_BIND_SERVICE";
    default:
      return "cannot listen on " + where + ": " + std::strerror(error);
  }
}

bool enable(int socket, int option) {
  const int on = 1;
  return setsockopt(socket, SOL_SOCKET, option, &on, sizeof on) == 0;
}

// Only root may go beyond net.core.rmem_max; anyone else gets that much.
int grow_buffer(int socket) {
  if (setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &kWantedBuffer, sizeof kWantedBuffer) != 0) {
    setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &kWantedBuffer, sizeof kWantedBuffer);
  }
  int bytes = 0;
  socklen_t size = sizeof bytes;
  getsockopt(socket, SOL_SOCKET, SO_RCVBUF, &bytes, &size);
  return bytes;
}

}  // namespace

Result<UdpReceiver> UdpReceiver::open(const std::string& address, int port,
                                      const std::string& sender) {
  sockaddr_in local{};
  local.sin_family = AF_INET;
  local.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &local.sin_addr) != 1) {
    return fail("\"" + address + "\" is not an IPv4 address to listen on, as 0.0.0.0 is");
  }
  in_addr accepted{};
  if (!sender.empty() && inet_pton(AF_INET, sender.c_str(), &accepted) != 1) {
    return fail("\"" + sender + "\" is not the IPv4 address of a sender, as 192.168.1.201 is");
  }

  UdpReceiver receiver;
  receiver.accepted_sender_ = ntohl(accepted.s_addr);
  receiver.socket_ = Descriptor(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int descriptor = receiver.socket_.get();
  // SO_REUSEADDR stays off: a second daemon on the port would silently take the datagrams.
  if (descriptor < 0 || !enable(descriptor, SO_TIMESTAMPNS) || !enable(descriptor, SO_RXQ_OVFL) ||
      bind(descriptor, reinterpret_cast<const sockaddr*>(&local), sizeof local) != 0) {
    return fail(reason_of(errno, address, port));
  }
  socklen_t size = sizeof local;
  getsockname(descriptor, reinterpret_cast<sockaddr*>(&local), &size);
  receiver.port_ = ntohs(local.sin_port);
  receiver.buffer_bytes_ = grow_buffer(descriptor);
  return receiver;
}

std::optional<ReceivedDatagram> UdpReceiver::receive(std::span<std::uint8_t> buffer) {
  while (true) {
    const std::uint32_t drops_before = last_drops_;
    const SocketMessage message = receive_message(socket_.get(), buffer, last_drops_);
    if (message.size < 0) {
      if (errno != EAGAIN && errno != EWOULDBLOCK) ++counts_.errors;
      return std::nullopt;
    }
    counts_.kernel_drops += last_drops_ - drops_before;
    ReceivedDatagram datagram;
    datagram.arrival_ns = message.arrival_ns;
    datagram.sender = ntohl(message.sender.sin_addr.s_addr);
    datagram.sender_port = ntohs(message.sender.sin_port);
    if (accepted_sender_ != 0 && datagram.sender != accepted_sender_) {
      ++counts_.foreign;
      continue;
    }
    datagram.bytes = buffer.first(static_cast<std::size_t>(message.size));
    datagram.truncated = message.is_truncated;
    ++counts_.received;
    counts_.truncated += datagram.truncated ? 1 : 0;
    return datagram;
  }
}

}  // namespace scree
