#include "replay/udp_target.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "commands.hpp"

namespace scree::cli {

UdpTarget::UdpTarget(const std::string& address, int port)
    : name_(address + ":" + std::to_string(port)), socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &to.sin_addr) != 1) {
    throw CLI::ValidationError("--address", "must be an IPv4 address, as in 127.0.0.1:2368");
  }
  if (!socket_.is_open())
    throw Failure(std::string("cannot open a socket: ") + std::strerror(errno));
  const int on = 1;
  setsockopt(socket_.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
  if (connect(socket_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
    throw Failure("cannot send to " + name_ + ": " + std::strerror(errno));
  }
}

void UdpTarget::send(std::span<const std::uint8_t> bytes) {
  if (::send(socket_.get(), bytes.data(), bytes.size(), 0) >= 0) {
    ++sent_;
  } else if (errno == ECONNREFUSED) {
    ++refused_;
  } else if (errno != EINTR) {
    throw Failure("cannot send to " + name_ + ": " + std::strerror(errno));
  }
}

}  // namespace scree::cli
