#include "scree/drivers/encoder/can_socket.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace scree::encoder {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Stands for an adapter: a pair of sockets that keeps the borders of frames and stamps them as the
/// kernel's CAN does, and can be unplugged.
class Adapter {
public:
  CanSocket::Device device() {
    return {[this] { return plug_in(); }, [this](const Descriptor&) { return is_up; }};
  }
  void send(const void* bytes, std::size_t size) const {
    ASSERT_EQ(::send(bus_.get(), bytes, size, 0), static_cast<ssize_t>(size));
  }
  void send(canid_t id, const std::vector<std::uint8_t>& data) const {
    can_frame frame{};
    frame.can_id = id;
    frame.len = static_cast<std::uint8_t>(data.size());
    std::copy(data.begin(), data.end(), frame.data);
    send(&frame, sizeof frame);
  }
  void unplug() { bus_ = Descriptor(); }

  bool is_there = true, is_up = true;
  int opened = 0;

private:
  Result<Descriptor> plug_in() {
    if (!is_there) return fail("there is no such interface");
    ++opened;
    int ends[2] = {-1, -1};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends), 0);
    bus_ = Descriptor(ends[1]);
    const int on = 1;
    EXPECT_EQ(setsockopt(ends[0], SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on), 0);
    return Descriptor(ends[0]);
  }
  Descriptor bus_;
};

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::vector<int> data_of(const CanFrame& frame) {
  return {frame.payload().begin(), frame.payload().end()};
}

class CanSocketTest : public testing::Test {
protected:
  CanSocketTest() : socket_(*CanSocket::open(adapter_.device())) {}

  Adapter adapter_;
  CanSocket socket_;
};

TEST_F(CanSocketTest, HandsOverFramesWithTheKernelsStamp) {
  EXPECT_FALSE(socket_.receive());
  EXPECT_EQ(socket_.state(), BusState::silent);
  const std::int64_t before = now_ns();
  adapter_.send(0x1A0, {1, 2, 3});
  adapter_.send(0x18FF50E5 | CAN_EFF_FLAG, {});
  adapter_.send(0x1A0 | CAN_RTR_FLAG, {});
  auto frame = socket_.receive();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->id, 0x1A0U);
  EXPECT_FALSE(frame->is_extended || frame->is_error || frame->is_remote);
  EXPECT_THAT(data_of(*frame), ElementsAre(1, 2, 3));
  EXPECT_GE(frame->t_ns, before);
  EXPECT_LE(frame->t_ns, now_ns());
  frame = socket_.receive();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->id, 0x18FF50E5U);
  EXPECT_TRUE(frame->is_extended);
  EXPECT_TRUE(socket_.receive()->is_remote);
  EXPECT_FALSE(socket_.receive());
  EXPECT_EQ(socket_.counts().received, 3U);
  EXPECT_EQ(socket_.state(), BusState::active);
}

TEST_F(CanSocketTest, TakesFdFrames) {
  canfd_frame fd{};
  fd.can_id = 0x1A0;
  fd.len = 64;
  fd.data[63] = 7;
  adapter_.send(&fd, sizeof fd);
  const auto frame = socket_.receive();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->size, 64);
  EXPECT_EQ(frame->data[63], 7);
}

TEST_F(CanSocketTest, ErrorFramesAreHandedOverAndFollowed) {
  adapter_.send(CAN_ERR_FLAG | 0x40U, std::vector<std::uint8_t>(8, 0));
  const auto frame = socket_.receive();
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->is_error);
  EXPECT_EQ(frame->id, 0x40U);
  EXPECT_EQ(socket_.state(), BusState::bus_off);
  adapter_.send(CAN_ERR_FLAG | 0x100U, std::vector<std::uint8_t>(8, 0));
  EXPECT_TRUE(socket_.receive());
  EXPECT_EQ(socket_.state(), BusState::active);
}

TEST_F(CanSocketTest, WhatIsNoFrameIsCounted) {
  can_frame too_long{};
  too_long.len = 9;
  adapter_.send(&too_long, sizeof too_long);
  adapter_.send(&too_long, 3);
  const std::vector<std::uint8_t> longer_than_any(100, 0);
  adapter_.send(longer_than_any.data(), longer_than_any.size());
  adapter_.send(0x1A0, {5});
  const auto frame = socket_.receive();
  ASSERT_TRUE(frame);
  EXPECT_THAT(data_of(*frame), ElementsAre(5));
  EXPECT_EQ(socket_.counts().malformed, 3U);
}

TEST_F(CanSocketTest, ComesBackAfterUnplugging) {
  adapter_.send(0x1A0, {1});
  EXPECT_TRUE(socket_.receive());
  adapter_.is_there = false;
  adapter_.unplug();
  EXPECT_FALSE(socket_.receive());
  EXPECT_EQ(socket_.state(), BusState::absent);
  EXPECT_EQ(socket_.descriptor(), -1);

  std::int64_t now = 1'000'000'000'000;
  for (int i = 0; i < 1000; ++i) socket_.retry(now += CanSocket::kRetryNs / 10);
  EXPECT_EQ(socket_.state(), BusState::absent);
  EXPECT_FALSE(socket_.receive());
  adapter_.is_there = true;
  socket_.retry(now += CanSocket::kRetryNs);
  EXPECT_EQ(socket_.state(), BusState::silent);
  EXPECT_EQ(socket_.counts().reopened, 1U);
  adapter_.send(0x1A0, {2});
  EXPECT_TRUE(socket_.receive());
  EXPECT_EQ(socket_.state(), BusState::active);
  EXPECT_EQ(socket_.bus().removals, 1U);
}

TEST_F(CanSocketTest, TriesNoMoreOftenThanItSays) {
  adapter_.unplug();
  EXPECT_FALSE(socket_.receive());
  int tries = 0;
  CanSocket::Device device{[&]() -> Result<Descriptor> {
                             if (tries++ == 0) return Descriptor(open("/dev/null", O_RDONLY));
                             return fail("no");
                           },
                           [](const Descriptor&) { return false; }};
  auto socket = CanSocket::open(device);
  ASSERT_TRUE(socket);
  EXPECT_FALSE(socket->receive());  // no socket at all: of no use
  EXPECT_EQ(socket->state(), BusState::absent);
  std::int64_t now = 1'000'000'000'000;
  for (int i = 0; i < 100; ++i) socket->retry(now += CanSocket::kRetryNs / 10);
  EXPECT_EQ(tries, 1 + 10);
}

/// A socket bound to the loopback interface of a new network, where it begins down. There is no CAN
/// there, but a packet socket hears of an interface that goes down as a CAN socket does.
class Loopback {
public:
  Loopback() {
    std::thread([this] {
      if (unshare(CLONE_NEWNET) != 0) return;
      socket_ = Descriptor(socket(AF_PACKET, SOCK_RAW | SOCK_NONBLOCK, htons(ETH_P_CAN)));
      sockaddr_ll address{};
      address.sll_family = AF_PACKET;
      address.sll_protocol = htons(ETH_P_CAN);
      address.sll_ifindex = 1;
      if (bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        socket_ = Descriptor();
      }
    }).join();
  }
  bool is_there() const { return socket_.is_open(); }
  CanSocket::Device device() {
    return {[this]() -> Result<Descriptor> { return Descriptor(dup(socket_.get())); },
            [this](const Descriptor&) { return (flags().ifr_flags & IFF_UP) != 0; }};
  }
  void set_up(bool up) {
    ifreq request = flags();
    constexpr int kUp = IFF_UP;
    request.ifr_flags = static_cast<short>(up ? request.ifr_flags | kUp : request.ifr_flags & ~kUp);
    EXPECT_EQ(ioctl(socket_.get(), SIOCSIFFLAGS, &request), 0);
  }

private:
  ifreq flags() const {
    ifreq request{};
    std::string("lo").copy(request.ifr_name, IFNAMSIZ - 1);
    EXPECT_EQ(ioctl(socket_.get(), SIOCGIFFLAGS, &request), 0);
    return request;
  }
  Descriptor socket_;
};

TEST(CanSocket, WaitsForAnInterfaceThatIsDown) {
  Loopback loopback;
  if (!loopback.is_there()) GTEST_SKIP() << "a network of its own takes the right CAP_SYS_ADMIN";
  auto socket = CanSocket::open(loopback.device());
  ASSERT_TRUE(socket);
  EXPECT_FALSE(socket->receive());
  EXPECT_EQ(socket->state(), BusState::down);
  std::int64_t now = 1'000'000'000'000;
  socket->retry(now += CanSocket::kRetryNs);
  EXPECT_EQ(socket->state(), BusState::down);
  loopback.set_up(true);
  socket->retry(now += CanSocket::kRetryNs);
  EXPECT_EQ(socket->state(), BusState::silent);
  loopback.set_up(false);
  // poll() must wake the reader, and only once.
  pollfd poll_for{socket->descriptor(), POLLIN, 0};
  EXPECT_EQ(poll(&poll_for, 1, 10000), 1);
  EXPECT_FALSE(socket->receive());
  EXPECT_EQ(poll(&poll_for, 1, 0), 0);
  EXPECT_EQ(socket->state(), BusState::down);
  EXPECT_EQ(socket->bus().downs, 2U);
  EXPECT_EQ(socket->counts().reopened, 0U);
}

TEST(CanSocket, AnInterfaceThatIsNotThereIsOneSentence) {
  for (const char* name : {"nocan0", "", "a_name_longer_than_fifteen"}) {
    const auto socket = CanSocket::open(name);
    ASSERT_FALSE(socket);
    EXPECT_THAT(socket.error().message,
                AllOf(HasSubstr("cannot use CAN interface"), HasSubstr(name)));
  }
  EncoderSettings settings;
  settings.interface = "nocan0";
  EXPECT_FALSE(CanSocket::open(settings));
}

}  // namespace
}  // namespace scree::encoder
