#include "scree/publish/subscriber.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "publish/lcm_datagrams.hpp"
#include "publish/message_bounds.hpp"
#include "scree/publish/publisher.hpp"
#include "unit/deaf_server.hpp"
#include "unit/free_port.hpp"
#include "unit/recordings.hpp"
#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

void append(Bytes& bytes, std::uint64_t value, int size) {
  for (int i = size - 1; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

void append(Bytes& bytes, const std::string& text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
  bytes.push_back(0);
}

Bytes whole(const std::string& channel, const Bytes& data) {
  Bytes bytes;
  append(bytes, 0x4C433032, 4), append(bytes, 1, 4);
  append(bytes, channel);
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

/// @param channel only of the first fragment, of index 0
Bytes fragment(std::uint32_t sequence, std::uint32_t size, std::uint32_t offset, int index,
               const Bytes& data, const std::string& channel = "C") {
  Bytes bytes;
  append(bytes, 0x4C433033, 4), append(bytes, sequence, 4), append(bytes, size, 4);
  append(bytes, offset, 4), append(bytes, static_cast<std::uint64_t>(index), 2);
  append(bytes, 2, 2);
  if (index == 0) append(bytes, channel);
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

TEST(LcmDatagrams, GiveWholeMessagesAndThoseInFragments) {
  LcmDatagrams datagrams;
  const Bytes datagram = whole("SCREE_HEALTH", {1, 2, 3});
  const auto message = datagrams.take(datagram, 1);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->channel, "SCREE_HEALTH");
  EXPECT_THAT(message->data, testing::ElementsAre(1, 2, 3));
  EXPECT_FALSE(datagrams.take(fragment(7, 5, 0, 0, {1, 2, 3}), 1));
  EXPECT_FALSE(datagrams.take(fragment(7, 4, 0, 0, {9, 9}), 2)) << "another sender's";
  const auto joined = datagrams.take(fragment(7, 5, 3, 1, {4, 5}), 1);
  ASSERT_TRUE(joined);
  EXPECT_EQ(joined->channel, "C");
  EXPECT_THAT(joined->data, testing::ElementsAre(1, 2, 3, 4, 5));
  EXPECT_EQ(datagrams.refused(), 0U);
}

TEST(LcmDatagrams, HostileOnesAreRefused) {
  LcmDatagrams datagrams;
  EXPECT_FALSE(datagrams.take(fragment(1, 100, 0xFFFFFFF0, 0, Bytes(50)), 1));
  EXPECT_FALSE(datagrams.take(fragment(2, 100, 0, 0, Bytes(50)), 1));
  EXPECT_FALSE(datagrams.take(fragment(2, 100, 0xFFFFFFF0, 1, Bytes(50)), 1));
  EXPECT_FALSE(datagrams.take(fragment(3, 0xFFFFFFFF, 0, 0, Bytes(50)), 1));
  EXPECT_FALSE(datagrams.take(fragment(4, 10, 0, 0, Bytes(50)), 1));
  EXPECT_FALSE(datagrams.take(fragment(5, 100, 50, 1, Bytes(50)), 1)) << "the first is missing";
  EXPECT_FALSE(datagrams.take(whole(std::string(64, 'x'), {}), 1));
  EXPECT_FALSE(datagrams.take(Bytes{'L', 'C', '0', '2', 0, 0, 0, 1, 'x'}, 1)) << "without an end";
  EXPECT_FALSE(datagrams.take(Bytes{}, 1));
  EXPECT_EQ(datagrams.refused(), 8U);
  std::mt19937 random(2);
  for (int round = 0; round < 20000; ++round) {
    const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random()) % n; };
    Bytes bytes = round % 2 == 0 ? fragment(below(3), below(200), below(100),
                                            static_cast<int>(below(3)), Bytes(below(60)))
                                 : whole("C", Bytes(below(60)));
    bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    bytes.resize(random() % (bytes.size() + 1));
    datagrams.take(bytes, random() % 3);
  }
}

health_t whole_health() {
  health_t health{};
  health.version = "1.0";
  health.reason = "";
  health.setup_size = 2;
  health.setup = {"one", "another"};
  health.lidar.reasons = 2;
  health.lidar.refused_reason = {"size", "late"};
  health.lidar.refused = {1, 2};
  health.stages_size = health.queues_size = health.threads_size = 1;
  health.stages.resize(1), health.queues.resize(1), health.threads.resize(1);
  health.stages[0].name = "map";
  return health;
}

obstacle_list_t list_of_two() {
  obstacle_list_t list{};
  list.size = 2;
  list.obstacles.resize(2);
  list.obstacles[1].corners = 3;
  list.obstacles[1].footprint.assign(3, std::vector<double>(2));
  return list;
}

grid_t small_grid() {
  grid_t grid{};
  grid.columns = 3, grid.rows = 2, grid.cells = 6;
  grid.state.resize(6), grid.ground.resize(6);
  return grid;
}

template <class Message>
Bytes encoded(const Message& message) {
  Bytes bytes(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_GE(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
  return bytes;
}

/// What the bounds let pass can be decoded, and takes no more than what is there.
template <class Message>
void expect_bounded(const Message& message, bool (*is_sound)(std::span<const std::uint8_t>)) {
  const Bytes good = encoded(message);
  EXPECT_TRUE(is_sound(good));
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(is_sound(std::span(good).first(size))) << size;
  }
  std::mt19937 random(3);
  for (int round = 0; round < 20000; ++round) {
    Bytes bytes = good;
    for (int flips = 0; flips < 3; ++flips) {
      bytes[8 + random() % (bytes.size() - 8)] =
          static_cast<std::uint8_t>(random() % 3 == 0 ? 0xFF : random());
    }
    Message decoded{};
    if (is_sound(bytes)) {
      EXPECT_GE(decoded.decode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
    }
  }
}

TEST(MessageBounds, WhatPassesThemCanBeDecoded) {
  expect_bounded(whole_health(), is_health);
  expect_bounded(list_of_two(), is_obstacle_list);
  expect_bounded(small_grid(), is_grid);
}

TEST(MessageBounds, AListOfTwoThousandMillionsIsNone) {
  Bytes bytes = encoded(list_of_two());
  const std::size_t size_at = 8 + 8 + 7 * 8;
  bytes[size_at] = 0x7F, bytes[size_at + 1] = bytes[size_at + 2] = bytes[size_at + 3] = 0xFF;
  EXPECT_FALSE(is_obstacle_list(bytes));
}

class SubscriberTest : public testing::Test {
protected:
  SubscriberTest() {
    auto opened = Subscriber::open(
        url_, [](const obstacle_list_t&) {}, [this](const health_t&) { ++healths_; });
    EXPECT_TRUE(opened) << opened.error().message;
    subscriber_ = std::move(*opened);
  }
  void send(const Bytes& datagram) const {
    const Descriptor sender(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    sockaddr_in group{};
    group.sin_family = AF_INET;
    group.sin_port = htons(static_cast<std::uint16_t>(port_));
    inet_pton(AF_INET, "239.255.76.67", &group.sin_addr);
    const int hops = 0;
    setsockopt(sender.get(), IPPROTO_IP, IP_MULTICAST_TTL, &hops, sizeof hops);
    EXPECT_EQ(sendto(sender.get(), datagram.data(), datagram.size(), 0,
                     reinterpret_cast<const sockaddr*>(&group), sizeof group),
              static_cast<ssize_t>(datagram.size()));
  }

  int port_ = free_port();
  std::string url_ = "udpm://239.255.76.67:" + std::to_string(port_) + "?ttl=0";
  std::unique_ptr<Subscriber> subscriber_;
  int healths_ = 0;
};

TEST_F(SubscriberTest, GoesOnAfterMalformedMessages) {
  Bytes hostile = encoded(list_of_two());
  hostile[8 + 8 + 7 * 8] = 0x7F;
  send(whole("SCREE_OBSTACLES", hostile));
  send(fragment(1, 100, 0xFFFFFFF0, 0, Bytes(50), "SCREE_OBSTACLES"));
  send(whole("OF_SOMEBODY_ELSE", {1, 2, 3}));
  Bytes older = encoded(whole_health());
  older[0] ^= 1;  // the hash of another version
  send(whole("SCREE_HEALTH", older));
  send(whole("SCREE_HEALTH", encoded(whole_health())));
  for (int i = 0; i < 20 && healths_ == 0; ++i) EXPECT_TRUE(subscriber_->handle(500));
  EXPECT_EQ(healths_, 1);
  EXPECT_EQ(subscriber_->refused(), 3U);
}

TEST_F(SubscriberTest, AMessageFromTheFieldIsRefused) {
  NEEDS("field/lcm_message/msg.bin");
  const std::string bytes = bytes_of(shared("field/lcm_message/msg.bin"));
  send(Bytes(bytes.begin(), bytes.end()));
  for (int i = 0; i < 20 && subscriber_->refused() == 0; ++i) EXPECT_TRUE(subscriber_->handle(500));
  EXPECT_EQ(subscriber_->refused(), 1U);
  EXPECT_EQ(healths_, 0);
}

TEST(Subscriber, AServerThatDoesNotAnswerIsOneSentence) {
  const auto opened = Subscriber::open(
      "tcpq://127.0.0.1:1", [](const obstacle_list_t&) {}, [](const health_t&) {});
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message, HasSubstr("tcpq://127.0.0.1:1"));
}

TEST(Subscriber, AServerThatTakesTheConnectionAndIsSilentIsOneSentence) {
  const DeafServer server(false);
  const auto subscriber = Subscriber::open(
      server.url(), [](const obstacle_list_t&) {}, [](const health_t&) {});
  ASSERT_FALSE(subscriber);
  EXPECT_THAT(subscriber.error().message, HasSubstr(server.url()));
  const auto publisher = Publisher::open(server.url());
  ASSERT_FALSE(publisher);
  EXPECT_THAT(publisher.error().message, HasSubstr("is there a server that answers?"));
}

}  // namespace
}  // namespace scree
