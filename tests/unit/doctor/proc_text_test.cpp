#include "doctor/proc_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/capability.h>

#include <random>
#include <string>

namespace scree {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

// As Linux 6.1 writes them.
constexpr std::string_view kUdp =
    "   sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout "
    "inode ref pointer drops             \n"
    " 2035: 00000000:0940 00000000:0000 07 00000000:00000000 00:00000000 00000000   997        0 "
    "28671 2 0000000000000000 0         \n"
    " 7975: 0100007F:2074 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 "
    "19442 2 0000000000000000 12        \n";

constexpr std::string_view kLimits =
    "Limit                     Soft Limit           Hard Limit           Units     \n"
    "Max cpu time              unlimited            unlimited            seconds   \n"
    "Max locked memory         8388608              unlimited            bytes     \n"
    "Max realtime priority     40                   50                             \n"
    "Max realtime timeout      unlimited            unlimited            us        \n";

constexpr std::string_view kStatus =
    "Name:\tscreed\nUmask:\t0077\nVmPeak:\t  409600 kB\nVmLck:\t  204800 kB\n"
    "CapPrm:\t000001ffffffffff\nCapEff:\t0000000000800000\n";

TEST(ProcText, SocketsHavePortAddressAndInode) {
  const auto sockets = parse_udp_sockets(kUdp);
  ASSERT_THAT(sockets, SizeIs(2));
  EXPECT_EQ(sockets[0].port, 2368);
  EXPECT_EQ(sockets[0].address, 0U);
  EXPECT_EQ(sockets[0].inode, 28671U);
  EXPECT_EQ(sockets[1].port, 8308);
  EXPECT_EQ(sockets[1].address, 0x7F000001U);
  EXPECT_THAT(parse_udp_sockets(""), IsEmpty());
}

TEST(ProcText, LimitsMayBeUnlimited) {
  EXPECT_EQ(parse_limit(kLimits, "Max realtime priority"), 40U);
  EXPECT_EQ(parse_limit(kLimits, "Max locked memory"), 8388608U);
  EXPECT_EQ(parse_limit(kLimits, "Max cpu time"), kUnlimited);
  EXPECT_EQ(parse_limit(kLimits, "Max open files"), std::nullopt);
}

TEST(ProcText, StatusHasValuesAndCapabilities) {
  EXPECT_EQ(status_value(kStatus, "VmLck"), "204800 kB");
  EXPECT_EQ(status_value(kStatus, "Vm"), "");
  EXPECT_TRUE(has_capability(kStatus, CAP_SYS_NICE));
  EXPECT_FALSE(has_capability(kStatus, CAP_IPC_LOCK));
  EXPECT_FALSE(has_capability("", CAP_SYS_NICE));
}

TEST(ProcText, StatHasThePolicy) {
  const auto stat = [](const char* name, int policy) {
    return "4242 (" + std::string(name) +
           ") S 1 4242 4242 0 -1 4194304 1 0 0 0 0 0 0 0 -41 0 6 0 100 409600 200 "
           "18446744073709551615 1 1 0 0 0 0 0 4096 0 1 0 0 17 1 40 " +
           std::to_string(policy) + " 0 0 0 0 0 0 0 0 0 0 0\n";
  };
  EXPECT_TRUE(is_real_time(stat("lidar", 1)));
  EXPECT_TRUE(is_real_time(stat("a) (b", 2)));
  EXPECT_FALSE(is_real_time(stat("detector", 0)));
  EXPECT_FALSE(is_real_time("4242 (short) S 1"));
  EXPECT_FALSE(is_real_time(""));
}

TEST(ProcText, SurvivesAnyText) {
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    std::string text(round % 2 == 0 ? kUdp : kLimits);
    text.resize(random() % text.size());
    for (int i = 0; i < 5 && !text.empty(); ++i) {
      text[random() % text.size()] = static_cast<char>(random());
    }
    EXPECT_LE(parse_udp_sockets(text).size(), 3U);
    parse_limit(text, "Max realtime priority");
    status_value(text, "VmLck");
    is_real_time(text);
  }
}

}  // namespace
}  // namespace scree
