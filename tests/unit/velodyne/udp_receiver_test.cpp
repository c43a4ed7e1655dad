#include "scree/drivers/velodyne/udp_receiver.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <vector>

#include "scree/core/ipv4.hpp"

namespace scree {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

/// Sends datagrams to a port of this computer, from a loopback address of choice.
class Sender {
public:
  explicit Sender(int port, const char* from = "127.0.0.1")
      : socket_(socket(AF_INET, SOCK_DGRAM, 0)), to_(address("127.0.0.1", port)) {
    const sockaddr_in source = address(from, 0);
    EXPECT_EQ(bind(socket_.get(), reinterpret_cast<const sockaddr*>(&source), sizeof source), 0);
  }
  void send(const std::vector<std::uint8_t>& bytes) const {
    EXPECT_EQ(sendto(socket_.get(), bytes.data(), bytes.size(), 0,
                     reinterpret_cast<const sockaddr*>(&to_), sizeof to_),
              static_cast<ssize_t>(bytes.size()));
  }

private:
  static sockaddr_in address(const char* text, int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    inet_pton(AF_INET, text, &address.sin_addr);
    return address;
  }
  Descriptor socket_;
  sockaddr_in to_;
};

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

class UdpReceiverTest : public ::testing::Test {
protected:
  UdpReceiver open(const std::string& sender = "") {
    auto receiver = UdpReceiver::open("127.0.0.1", 0, sender);
    EXPECT_TRUE(receiver) << receiver.error().message;
    return std::move(*receiver);
  }
  std::optional<ReceivedDatagram> wait(UdpReceiver& receiver) {
    pollfd poll_for{receiver.descriptor(), POLLIN, 0};
    EXPECT_EQ(poll(&poll_for, 1, 10000), 1);
    return receiver.receive(buffer_);
  }
  std::array<std::uint8_t, 16> buffer_{};
};

TEST_F(UdpReceiverTest, HandsOverBytesSenderAndKernelStamp) {
  UdpReceiver receiver = open();
  EXPECT_FALSE(receiver.receive(buffer_));
  const std::int64_t before = now_ns();
  Sender(receiver.port()).send({1, 2, 3});
  const auto datagram = wait(receiver);
  ASSERT_TRUE(datagram);
  EXPECT_THAT(datagram->bytes, ElementsAreArray({1, 2, 3}));
  EXPECT_EQ(ipv4_text(datagram->sender), "127.0.0.1");
  EXPECT_FALSE(datagram->truncated);
  EXPECT_GE(datagram->arrival_ns, before);
  EXPECT_LE(datagram->arrival_ns, now_ns());
  EXPECT_EQ(receiver.counts().received, 1U);
}

TEST_F(UdpReceiverTest, FlagsTruncationAndTakesAnEmptyDatagram) {
  UdpReceiver receiver = open();
  const Sender sender(receiver.port());
  sender.send(std::vector<std::uint8_t>(17, 9));
  sender.send(std::vector<std::uint8_t>(16, 8));
  sender.send({});
  auto datagram = wait(receiver);
  ASSERT_TRUE(datagram);
  EXPECT_TRUE(datagram->truncated);
  EXPECT_EQ(datagram->bytes.size(), 16U);
  datagram = wait(receiver);
  ASSERT_TRUE(datagram);
  EXPECT_FALSE(datagram->truncated);
  datagram = wait(receiver);
  ASSERT_TRUE(datagram);
  EXPECT_TRUE(datagram->bytes.empty());
  EXPECT_EQ(receiver.counts().truncated, 1U);
}

TEST_F(UdpReceiverTest, IgnoresAndCountsOtherSenders) {
  UdpReceiver receiver = open("127.0.0.3");
  Sender(receiver.port(), "127.0.0.2").send({1});
  Sender(receiver.port(), "127.0.0.3").send({2});
  const auto datagram = wait(receiver);
  ASSERT_TRUE(datagram);
  EXPECT_THAT(datagram->bytes, ElementsAreArray({2}));
  EXPECT_EQ(ipv4_text(datagram->sender), "127.0.0.3");
  EXPECT_EQ(receiver.counts().foreign, 1U);
  EXPECT_EQ(receiver.counts().received, 1U);
}

TEST_F(UdpReceiverTest, CountsWhatTheKernelDropped) {
  UdpReceiver receiver = open();
  const Sender sender(receiver.port());
  // Even the smallest datagram takes hundreds of bytes in the kernel, so these overflow the buffer.
  const int sent = receiver.buffer_bytes() / 256;
  for (int i = 0; i < sent; ++i) sender.send({1});
  std::uint64_t received = 0;
  while (receiver.receive(buffer_)) ++received;
  // The count of drops travels with the next datagram that fits.
  sender.send({2});
  ASSERT_TRUE(wait(receiver));
  EXPECT_GT(receiver.counts().kernel_drops, 0U);
  EXPECT_EQ(received + receiver.counts().kernel_drops, static_cast<std::uint64_t>(sent));
}

TEST_F(UdpReceiverTest, APortInUseIsOneSentence) {
  const UdpReceiver first = open();
  const auto second = UdpReceiver::open("0.0.0.0", first.port(), "");
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message,
              AllOf(HasSubstr("port " + std::to_string(first.port())), HasSubstr("in use")));
}

TEST_F(UdpReceiverTest, AnInterfaceIsLookedForWithoutItsPort) {
  const UdpReceiver first = open();
  EXPECT_TRUE(check_interface("0.0.0.0"));
  EXPECT_TRUE(check_interface("127.0.0.1"));
  EXPECT_EQ(check_interface("192.0.2.77").error().message,
            "cannot listen on 192.0.2.77: no interface of this computer has that address");
}

TEST_F(UdpReceiverTest, AddressesAreChecked) {
  EXPECT_THAT(UdpReceiver::open("192.0.2.77", 0, "").error().message,
              HasSubstr("no interface of this computer"));
  EXPECT_THAT(UdpReceiver::open("robot", 0, "").error().message, HasSubstr("\"robot\""));
  EXPECT_THAT(UdpReceiver::open("0.0.0.0", 0, "1.2.3").error().message, HasSubstr("\"1.2.3\""));
}

}  // namespace
}  // namespace scree
