#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

namespace scree {

/// A UDP port that nobody uses now, chosen by the kernel, so that tests may run side by side.
inline int free_port() {
  const int probe = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof address;
  // Should it fail, the port is 0 and the test with it.
  static_cast<void>(bind(probe, reinterpret_cast<const sockaddr*>(&address), size));
  getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size);
  close(probe);
  return ntohs(address.sin_port);
}

/// An LCM url that no other test has.
inline std::string free_lcm_url() {
  return "udpm://239.255.76.67:" + std::to_string(free_port()) + "?ttl=0";
}

}  // namespace scree
