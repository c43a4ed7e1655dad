#include "scree/drivers/velodyne/udp_receiver.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <optional>

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
      return "cannot listen on " + address + ": no interface of this computer has that address";
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

/// @return in host byte order; nothing where it is no address, or that of a group
std::optional<std::uint32_t> address_of(const std::string& text) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) != 1) return std::nullopt;
  const std::uint32_t value = ntohl(address.s_addr);
  return IN_MULTICAST(value) ? std::nullopt : std::optional(value);
}

}  // namespace

Result<std::uint32_t> local_address(const std::string& text) {
  if (const auto address = address_of(text)) return *address;
  return fail(
      "\"" + text +
      "\" is not an IPv4 address of this computer to listen on, as 0.0.0.0 is (nor can it be "
      "a multicast group: let the sensor send to this computer or to 255.255.255.255)");
}

Result<std::uint32_t> sender_address(const std::string& text) {
  if (text.empty()) return 0;
  const auto address = address_of(text);
  const bool is_host =
      address && *address != INADDR_ANY && *address != INADDR_BROADCAST && !IN_MULTICAST(*address);
  if (is_host) return *address;
  return fail("\"" + text +
              "\" is not the IPv4 address of a sender, as 192.168.1.201 is (no name, no port)");
}

Result<void> check_interface(const std::string& address) {
  const auto any_port = UdpReceiver::open(address, 0, "");
  return any_port ? Result<void>() : tl::make_unexpected(any_port.error());
}

Result<UdpReceiver> UdpReceiver::open(const std::string& address, int port,
                                      const std::string& sender) {
  const auto listened = local_address(address), accepted = sender_address(sender);
  if (!listened) return tl::make_unexpected(listened.error());
  if (!accepted) return tl::make_unexpected(accepted.error());
  sockaddr_in local{};
  local.sin_family = AF_INET;
  local.sin_port = htons(static_cast<std::uint16_t>(port));
  local.sin_addr.s_addr = htonl(*listened);

  UdpReceiver receiver;
  receiver.accepted_sender_ = *accepted;
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
