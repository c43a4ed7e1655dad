#include "scree/drivers/encoder/can_sender.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <sys/socket.h>

#include <cerrno>

namespace scree::encoder {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class CanSenderTest : public testing::Test {
protected:
  CanSenderTest() {
    int ends[2] = {-1, -1};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends), 0);
    sender_ = CanSender(Descriptor(ends[0]));
    bus_ = Descriptor(ends[1]);
  }
  /// What came on the bus, and its size.
  std::pair<canfd_frame, ssize_t> next() const {
    canfd_frame frame{};
    const ssize_t size = recv(bus_.get(), &frame, sizeof frame, 0);
    return {frame, size};
  }

  CanSender sender_{Descriptor()};
  Descriptor bus_;
};

TEST_F(CanSenderTest, WritesFramesAsTheKernelTakesThem) {
  CanFrame frame;
  frame.id = 0x1A0;
  frame.size = 3;
  frame.data = {1, 2, 3};
  EXPECT_EQ(sender_.send(frame), 0);
  auto [wire, size] = next();
  EXPECT_EQ(size, 16);  // sizeof(struct can_frame)
  EXPECT_EQ(wire.can_id, 0x1A0U);
  EXPECT_EQ(wire.len, 3);
  EXPECT_EQ(wire.data[2], 3);

  frame.id = 0x18FF50E5;
  frame.is_extended = frame.is_remote = true;
  EXPECT_EQ(sender_.send(frame), 0);
  std::tie(wire, size) = next();
  EXPECT_EQ(wire.can_id, 0x80000000U | 0x40000000U | 0x18FF50E5U);
  EXPECT_EQ(wire.len, 3);
  EXPECT_EQ(wire.data[2], 0);

  frame = {};
  frame.id = 0x40;
  frame.is_error = true;
  frame.size = 8;
  EXPECT_EQ(sender_.send(frame), 0);
  EXPECT_EQ(next().first.can_id, 0x20000000U | 0x40U);
}

TEST_F(CanSenderTest, LongFramesAreFdFrames) {
  CanFrame frame;
  frame.size = 64;
  frame.data[63] = 7;
  EXPECT_EQ(sender_.send(frame), 0);
  const auto [wire, size] = next();
  EXPECT_EQ(size, 72);  // sizeof(struct canfd_frame)
  EXPECT_EQ(wire.len, 64);
  EXPECT_EQ(wire.data[63], 7);
}

TEST_F(CanSenderTest, AFullQueueDoesNotBlock) {
  int error = 0;
  for (int i = 0; i < 1'000'000 && error == 0; ++i) error = sender_.send({});
  EXPECT_EQ(error, EAGAIN);
  bus_ = Descriptor();
  EXPECT_NE(sender_.send({}), 0);
}

TEST(CanSender, AnInterfaceThatIsNotThereIsOneSentence) {
  const auto sender = CanSender::open("nocan0");
  ASSERT_FALSE(sender);
  EXPECT_THAT(sender.error().message, AllOf(HasSubstr("CAN interface nocan0"), HasSubstr("`")));
}

}  // namespace
}  // namespace scree::encoder
