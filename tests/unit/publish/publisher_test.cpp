#include "scree/publish/publisher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "allocation_counter.hpp"
#include "scree/publish/jsonl.hpp"
#include "scree/publish/messages.hpp"
#include "scree/publish/multicast.hpp"
#include "scree/publish/subscriber.hpp"
#include "unit/free_port.hpp"

namespace scree {
namespace {

using ::testing::HasSubstr;

ObstacleList list_of(std::size_t size) {
  ObstacleList list(size);
  list.stamp_ns = 1598601600123456789;
  list.pose.translation = {1, 2, 3};
  list.pose.rotation = from_roll_pitch_yaw(0.1, 0.2, 0.3);
  for (std::size_t i = 0; i < size; ++i) {
    Obstacle obstacle;
    obstacle.id = static_cast<std::int64_t>(i) + 5;
    obstacle.kind = i % 2 == 0 ? ObstacleKind::positive : ObstacleKind::negative;
    obstacle.confidence = 0.7F;
    obstacle.center = {1.0 / 3, 2, static_cast<double>(i)};
    obstacle.extent = {0.1, 0.2, 0.3};
    obstacle.yaw = -0.4;
    obstacle.height = 0.5;
    obstacle.velocity = {0.25, -1.0 / 7};
    obstacle.points = 12;
    obstacle.evidence = static_cast<Evidence>(i % kEvidenceNames.size());
    for (std::size_t corner = 0; i % 3 != 0 && corner < 3 + i % 14; ++corner) {
      obstacle.footprint.push_back({static_cast<double>(corner), 0.1 * static_cast<double>(i)});
    }
    list.obstacles.push_back(obstacle);
  }
  return list;
}

std::string json(const ObstacleList& list) {
  std::string text;
  append_json_line(list, text);
  return text;
}

TEST(Messages, WithRoomMadeListsOfAnyLengthAllocateNothing) {
  const ObstacleList longest = list_of(40), shorter = list_of(7);
  obstacle_list_t message{};
  make_room(40, message);
  const int most = message.getEncodedSize();
  ObstacleList back(40);
  const std::size_t before = test::allocations();
  for (const ObstacleList* list : {&longest, &shorter, &longest}) {
    to_message(*list, message);
    from_message(message, back);
  }
  EXPECT_EQ(test::allocations(), before);
  EXPECT_EQ(json(back), json(longest));
  EXPECT_LE(message.getEncodedSize(), most);
}

ObstacleGrid grid_of(std::size_t columns, std::size_t rows) {
  ObstacleGrid grid;
  grid.stamp_ns = 1598601600123456789;
  grid.pose.translation = {1, 2, 3};
  grid.pose.rotation = from_roll_pitch_yaw(0.1, 0.2, 0.3);
  grid.origin = {-4.2, 7.6};
  grid.cell_size = 0.2;
  grid.columns = columns;
  grid.rows = rows;
  for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
    const auto state = static_cast<CellState>(cell % kCellStates);
    grid.state.push_back(state);
    grid.ground.push_back(state == CellState::unknown
                              ? ObstacleGrid::kNoGround
                              : static_cast<std::int16_t>(cell % 700 - 350));
  }
  return grid;
}

TEST(Messages, WithRoomMadeGridsOfAnySizeAllocateNothing) {
  const ObstacleGrid largest = grid_of(ObstacleGrid::kMostCells, ObstacleGrid::kMostCells);
  const ObstacleGrid small = grid_of(4, 2);
  grid_t message{};
  make_room(message);
  const int most = message.getEncodedSize();
  const std::size_t before = test::allocations();
  for (const ObstacleGrid* grid : {&largest, &small, &largest, &small}) to_message(*grid, message);
  EXPECT_EQ(test::allocations(), before);
  EXPECT_EQ(message.cells, 8);
  EXPECT_LE(most, 65'000) << "it fits in one datagram";
}

TEST(Messages, AnUnknownEvidenceIsNone) {
  obstacle_list_t message{};
  to_message(list_of(2), message);
  message.obstacles[0].evidence = -1;
  message.obstacles[1].evidence = 99;
  ObstacleList list;
  from_message(message, list);
  EXPECT_EQ(list.obstacles[0].evidence, Evidence::none);
  EXPECT_EQ(list.obstacles[1].evidence, Evidence::none);
}

/// Receives messages of any type.
class Receiver {
public:
  explicit Receiver(const std::string& url) {
    auto opened = Subscriber::open(
        url, [this](const obstacle_list_t& message) { list_ = message; },
        [this](const health_t& message) { health_ = message; },
        [this](const grid_t& message) { grid_ = message; });
    EXPECT_TRUE(opened) << opened.error().message;
    subscriber_ = std::move(*opened);
  }
  obstacle_list_t receive(Publisher& publisher, const ObstacleList& sent) {
    return receive(publisher, sent, list_);
  }
  health_t receive(Publisher& publisher, const health_t& sent) {
    return receive(publisher, sent, health_);
  }
  grid_t receive(Publisher& publisher, const ObstacleGrid& sent) {
    return receive(publisher, sent, grid_);
  }

private:
  /// Sends each second until it has come, or fails after ten: a busy computer loses datagrams.
  template <class Sent, class Message>
  Message receive(Publisher& publisher, const Sent& sent, std::optional<Message>& message) {
    message.reset();
    for (int second = 0; second < 10 && !message; ++second) {
      EncodedMessage encoded;
      encoder_.encode(sent, encoded);
      EXPECT_TRUE(publisher.send(encoded));
      subscriber_->handle(1000);
    }
    EXPECT_TRUE(message);
    return message.value_or(Message{});
  }

  std::unique_ptr<Subscriber> subscriber_;
  MessageEncoder encoder_{1000};
  std::optional<obstacle_list_t> list_;
  std::optional<health_t> health_;
  std::optional<grid_t> grid_;
};

TEST(Publisher, ListsComeThroughUnchanged) {
  const std::string url = free_lcm_url();
  Receiver receiver(url);
  auto publisher = Publisher::open(url);
  ASSERT_TRUE(publisher) << publisher.error().message;
  // 1000 obstacles do not fit in one datagram: LCM sends them in fragments.
  for (const std::size_t size : {std::size_t{2}, std::size_t{0}, std::size_t{1000}}) {
    const ObstacleList sent = list_of(size);
    ObstacleList received;
    from_message(receiver.receive(*publisher, sent), received);
    EXPECT_EQ(json(received), json(sent));
  }
}

TEST(Publisher, GridsComeThroughUnchanged) {
  const std::string url = free_lcm_url();
  Receiver receiver(url);
  auto publisher = Publisher::open(url);
  ASSERT_TRUE(publisher) << publisher.error().message;
  for (const std::size_t side : {ObstacleGrid::kMostCells, std::size_t{3}}) {
    const ObstacleGrid sent = grid_of(side, side - side % 2);
    const grid_t received = receiver.receive(*publisher, sent);
    EXPECT_EQ(received.stamp_ns, sent.stamp_ns);
    EXPECT_EQ(received.p[2], 3);
    EXPECT_EQ(received.q[0], sent.pose.rotation.w());
    EXPECT_EQ(received.q[3], sent.pose.rotation.z());
    EXPECT_EQ(received.origin[0], -4.2);
    EXPECT_EQ(received.origin[1], 7.6);
    EXPECT_EQ(received.cell_size, 0.2);
    EXPECT_EQ(received.columns, static_cast<int>(sent.columns));
    EXPECT_EQ(received.rows, static_cast<int>(sent.rows));
    ASSERT_EQ(received.state.size(), sent.cells());
    for (std::size_t cell = 0; cell < sent.cells(); ++cell) {
      EXPECT_EQ(received.state[cell], cell % kCellStates);
      EXPECT_EQ(received.ground[cell], sent.ground[cell]);
    }
  }
}

TEST(Publisher, HealthComesThrough) {
  const std::string url = free_lcm_url();
  Receiver receiver(url);
  auto publisher = Publisher::open(url);
  ASSERT_TRUE(publisher) << publisher.error().message;
  health_t health{};
  health.state = health_t::BLIND;
  health.reason = std::string(500, 'x');
  health.lidar.refused_reason = {"wrong size", "wrong flag"};
  health.lidar.refused = {3, 4};
  health.lidar.reasons = 2;
  health.detector_time.p99_ms = 12.5;
  const health_t received = receiver.receive(*publisher, health);
  EXPECT_EQ(received.reason, health.reason);
  EXPECT_EQ(received.lidar.refused_reason, health.lidar.refused_reason);
  EXPECT_EQ(received.lidar.refused, health.lidar.refused);
  EXPECT_EQ(received.detector_time.p99_ms, 12.5);
}

TEST(Multicast, OtherProvidersNeedNoRoute) {
  EXPECT_TRUE(check_multicast("memq://"));
}

TEST(Multicast, AUrlWithoutGroupOrPortIsExplained) {
  for (const char* url : {"udpm://", "udpm://239.255.76.67", "udpm://127.0.0.1:7667",
                          "udpm://239.255.76.67:0", "udpm://239.255.76.67:7x", "udpm://robot:1"}) {
    const auto routed = check_multicast(url);
    ASSERT_FALSE(routed) << url;
    EXPECT_THAT(routed.error().message, HasSubstr(url));
    EXPECT_THAT(routed.error().message, HasSubstr("239.255.76.67:7667"));
  }
}

TEST(Multicast, TheTextOfAUrlIsCheckedWithoutARoute) {
  for (const char* url : {"udpm://239.1.2.3:7667?ttl=0", "tcpq://robot:7700", "memq://"}) {
    EXPECT_TRUE(check_lcm_url(url)) << url;
  }
  for (const char* url : {"", "pigeon://coop", "udpm://127.0.0.1:7667", "a\nb"}) {
    EXPECT_FALSE(check_lcm_url(url)) << url;
  }
}

TEST(Multicast, TheTtlIsANumberOfHops) {
  const std::string group = "udpm://239.1.2.3:7667?";
  for (const char* options : {"", "ttl=0", "ttl=255", "recv_buf_size=100000&ttl=1"}) {
    EXPECT_TRUE(check_lcm_url(group + options)) << options;
  }
  for (const char* options : {"ttl=", "ttl=256", "ttl=-1", "ttl=1x", "recv_buf_size=1&ttl=many"}) {
    const std::string url = group + options;
    const auto checked = check_lcm_url(url);
    ASSERT_FALSE(checked) << url;
    EXPECT_EQ(checked.error().message, "the ttl of the LCM url must be 0 to 255 (" + url + ")");
  }
}

TEST(Multicast, OptionsThatLcmWouldPassOverAreRefused) {
  const std::string group = "udpm://239.1.2.3:7667?";
  for (const char* options : {"tll=1", "recv_buf_size=-5", "recv_buf_size=abc", "ttl=0&x"}) {
    EXPECT_FALSE(check_lcm_url(group + options)) << options;
  }
  for (const char* url : {"tcpq://", "tcpq://robot", "tcpq://:7700", "tcpq://robot:7700?x"}) {
    EXPECT_TRUE(check_lcm_url(url)) << url;
  }
  for (const char* url : {"tcpq://robot:", "tcpq://robot:99999", "tcpq://robot:0"}) {
    EXPECT_FALSE(check_lcm_url(url)) << url;
  }
}

TEST(Publisher, AnUnknownProviderIsRefused) {
  const auto publisher = Publisher::open("pigeon://coop");
  ASSERT_FALSE(publisher);
  EXPECT_THAT(publisher.error().message, HasSubstr("pigeon://coop"));
}

}  // namespace
}  // namespace scree
