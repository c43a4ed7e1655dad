#include "app/lcm_sender.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <thread>

#include "scree/clock/clocks.hpp"
#include "scree/core/nanoseconds.hpp"
#include "scree/publish/subscriber.hpp"
#include "unit/free_port.hpp"

namespace scree {
namespace {

using std::chrono::milliseconds;

/// A server of LCM's provider tcpq that takes a client and never reads what it sends (lcm 1.4,
/// lcm_tcpq.c: both sides begin with a magic number and the version of the protocol).
class DeafServer {
public:
  DeafServer() {
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof here;
    EXPECT_EQ(bind(listener_.get(), reinterpret_cast<sockaddr*>(&here), size), 0);
    EXPECT_EQ(listen(listener_.get(), 1), 0);
    getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&here), &size);
    url_ = "tcpq://127.0.0.1:" + std::to_string(ntohs(here.sin_port));
    thread_ = std::thread([this] { take_client(); });
  }
  ~DeafServer() { thread_.join(); }
  const std::string& url() const { return url_; }

private:
  void take_client() {
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

TEST(LcmSender, WhatIsPutComesAndIsCounted) {
  const std::string url = free_lcm_url();
  int lists = 0;
  auto subscriber = Subscriber::open(
      url, [&](const obstacle_list_t&) { ++lists; }, [](const health_t&) {});
  auto publisher = Publisher::open(url);
  ASSERT_TRUE(subscriber && publisher);
  const auto sender = LcmSender::start(std::move(*publisher), 1);
  sender->put(ObstacleList(1), 42);
  EXPECT_TRUE(sender->put(health_t{}));
  EXPECT_TRUE(sender->finish(std::chrono::seconds(60)));
  EXPECT_EQ(sender->counts().lists, 1U);
  EXPECT_EQ(sender->counts().failed, 0U);
  EXPECT_EQ(sender->counts().last_list_ns, 42);
  for (int i = 0; i < 100 && lists == 0; ++i) (*subscriber)->handle(100);
  EXPECT_EQ(lists, 1);
}

TEST(LcmSender, AServerThatDoesNotReadBlocksNobodyAndWhatFindsNoRoomIsCounted) {
  DeafServer server;
  auto publisher = Publisher::open(server.url());
  ASSERT_TRUE(publisher) << publisher.error().message;
  const auto sender = LcmSender::start(std::move(*publisher), 1);
  health_t health{};
  health.reason = std::string(100'000, 'x');
  const std::int64_t end_ns = steady_ns() + 60 * kSecond;
  std::int64_t longest_ns = 0;
  while (sender->counts().health_failed < 100 && steady_ns() < end_ns) {
    const std::int64_t begin_ns = steady_ns();
    sender->put(health);
    longest_ns = std::max(longest_ns, steady_ns() - begin_ns);
    if (sender->counts().health_failed == 0) std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_GE(sender->counts().health_failed, 100U);
  EXPECT_LT(longest_ns, kSecond);
  EXPECT_FALSE(sender->finish(milliseconds(100)));
}

}  // namespace
}  // namespace scree
