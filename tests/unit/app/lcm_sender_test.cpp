#include "app/lcm_sender.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

#include "scree/clock/clocks.hpp"
#include "scree/core/nanoseconds.hpp"
#include "scree/publish/subscriber.hpp"
#include "unit/deaf_server.hpp"
#include "unit/free_port.hpp"

namespace scree {
namespace {

using std::chrono::milliseconds;

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
