#include "doctor/lidar_traffic.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace scree {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Verdict = Finding::Verdict;

constexpr std::uint32_t kSensor = 0xC0A801C9;  // 192.168.1.201
constexpr std::uint32_t kOwn = 0xC0A80164;     // 192.168.1.100
constexpr std::uint32_t kBroadcast = 0xFFFFFFFF;

class LidarTrafficTest : public testing::Test {
protected:
  LidarTrafficTest() {
    traffic_.own_addresses = {0x7F000001, kOwn};
    traffic_.seconds = 2;
  }
  void hear(std::size_t size) { traffic_.heard[{kSensor, 0, 2368, size}] = 1508; }
  void see(std::uint32_t destination, int port) {
    traffic_.seen = DatagramCounts{{{kSensor, destination, port, 1206}, 1508}};
  }
  std::string wrong() const {
    const Finding finding = check_lidar_traffic(lidar_, traffic_);
    EXPECT_EQ(finding.verdict, Verdict::wrong);
    return finding.text;
  }

  LidarSettings lidar_;
  LidarTraffic traffic_;
};

TEST_F(LidarTrafficTest, PacketsAreCounted) {
  hear(1206);
  const Finding finding = check_lidar_traffic(lidar_, traffic_);
  EXPECT_EQ(finding.verdict, Verdict::ok);
  EXPECT_THAT(finding.text, HasSubstr("754 packets a second of 1206 bytes from 192.168.1.201"));
}

TEST_F(LidarTrafficTest, OtherSizesAndSendersAreSaid) {
  hear(512);
  EXPECT_THAT(wrong(), AllOf(HasSubstr("512 bytes"), HasSubstr("lidar.port")));
  hear(1206);
  lidar_.sender = "192.168.1.77";
  EXPECT_THAT(wrong(), AllOf(HasSubstr("192.168.1.201"), HasSubstr("lidar.sender = 192.168.1.77")));
}

TEST_F(LidarTrafficTest, NothingAtAllIsTheCableOrTheSensor) {
  EXPECT_THAT(wrong(),
              AllOf(HasSubstr("nothing came to UDP port 2368 in 2 s"), HasSubstr("power and cable"),
                    HasSubstr("192.168.1.100"), HasSubstr("as root")));
  traffic_.seen.emplace();
  EXPECT_THAT(wrong(), Not(HasSubstr("as root")));
}

TEST_F(LidarTrafficTest, TheWireShowsWhereThePacketsGo) {
  see(kBroadcast, 2369);
  EXPECT_THAT(wrong(), HasSubstr("set lidar.port = 2369"));
  see(0xC0A8014D, 2368);
  EXPECT_THAT(wrong(), AllOf(HasSubstr("192.168.1.77, which is no address of this computer"),
                             HasSubstr("127.0.0.1, 192.168.1.100")));
  for (const std::uint32_t destination : {kBroadcast, kOwn, 0xC0A801FFU}) {
    see(destination, 2368);
    EXPECT_THAT(wrong(), AllOf(HasSubstr("firewall"), HasSubstr("rp_filter")));
  }
}

TEST_F(LidarTrafficTest, TwoSensorsOnOnePortAreNamed) {
  hear(1206);
  traffic_.heard[{kSensor + 1, 0, 2368, 1206}] = 1500;
  EXPECT_THAT(wrong(), AllOf(HasSubstr("from 192.168.1.201 and from 192.168.1.202"),
                             HasSubstr("lidar.sender")));
  lidar_.sender = "192.168.1.202";
  EXPECT_THAT(check_lidar_traffic(lidar_, traffic_).text, HasSubstr("from 192.168.1.202"));
}

}  // namespace
}  // namespace scree
