#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <string>
#include <thread>

#include "scree/core/descriptor.hpp"

namespace scree {

/// A server of LCM's provider tcpq that takes a client and never reads what it sends (lcm 1.4,
/// lcm_tcpq.c: both sides begin with a magic number and the version of the protocol).
class DeafServer {
public:
  explicit DeafServer(bool greets = true) {
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof here;
    EXPECT_EQ(bind(listener_.get(), reinterpret_cast<sockaddr*>(&here), size), 0);
    EXPECT_EQ(listen(listener_.get(), 2), 0);
    getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&here), &size);
    url_ = "tcpq://127.0.0.1:" + std::to_string(ntohs(here.sin_port));
    if (greets) thread_ = std::thread([this] { greet_client(); });
  }
  ~DeafServer() {
    if (thread_.joinable()) thread_.join();
  }
  const std::string& url() const { return url_; }

private:
  void greet_client() {
    client_ = Descriptor(accept(listener_.get(), nullptr, nullptr));
    std::array<std::uint32_t, 2> hello{};
    recv(client_.get(), hello.data(), sizeof hello, MSG_WAITALL);
    hello = {htonl(0x287617fa), htonl(0x0100)};
    send(client_.get(), hello.data(), sizeof hello, 0);
  }

  Descriptor listener_{::socket(AF_INET, SOCK_STREAM, 0)};
  Descriptor client_;
  std::string url_;
  std::thread thread_;
};

}  // namespace scree
