#include "doctor/can_link.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace scree {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;
using Verdict = Finding::Verdict;

Bytes u32(std::uint32_t value) {
  return {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8),
          static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 24)};
}

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// An attribute, filled up to four bytes. Numbers are those of linux/if_link.h and
/// linux/can/netlink.h.
Bytes attribute(unsigned type, const Bytes& value) {
  const std::size_t size = value.size() + 4;
  Bytes all = Bytes{static_cast<std::uint8_t>(size), static_cast<std::uint8_t>(size >> 8),
                    static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(type >> 8)} +
              value;
  all.resize((all.size() + 3) / 4 * 4);
  return all;
}

Bytes text(const std::string& characters) {
  return Bytes(characters.begin(), characters.end()) + Bytes{0};
}

constexpr std::uint32_t kUp = 0x1;
constexpr std::uint8_t kCan = 280 - 256;  // ARPHRD_CAN is 280

/// An answer as the kernel gives it: header, ifinfomsg, a name, the kind of link and its data.
Bytes answer(const std::string& kind, const Bytes& data, std::uint32_t flags) {
  const Bytes info = attribute(1, text(kind)) + attribute(2 | 0x8000, data);
  const Bytes interface = Bytes{0, 0, kCan, 1} + u32(4) + u32(flags) + u32(0);
  const Bytes body = interface + attribute(3, text("can0")) + attribute(18 | 0x8000, info);
  return u32(static_cast<std::uint32_t>(16 + body.size())) + Bytes{16, 0, 0, 0} + u32(0) + u32(0) +
         body;
}

Bytes can_data(std::uint32_t bit_rate, std::uint32_t restart_ms) {
  Bytes timing = u32(bit_rate);
  timing.resize(32);  // struct can_bittiming
  return attribute(4, u32(0)) + attribute(1, timing) + attribute(6, u32(restart_ms));
}

TEST(CanLink, ReadsTheKernelsAnswer) {
  const auto link = parse_can_link(answer("can", can_data(500000, 100), kUp));
  ASSERT_TRUE(link);
  EXPECT_TRUE(link->is_can && link->is_up);
  EXPECT_EQ(link->kind, "can");
  EXPECT_EQ(link->bit_rate, 500000U);
  EXPECT_EQ(link->restart_ms, 100U);
  const auto virtual_link = parse_can_link(answer("vcan", {}, 0));
  ASSERT_TRUE(virtual_link);
  EXPECT_EQ(virtual_link->kind, "vcan");
  EXPECT_FALSE(virtual_link->is_up);
}

TEST(CanLink, SurvivesAnyBytes) {
  EXPECT_FALSE(parse_can_link({}));
  std::mt19937 random(3);
  const Bytes whole = answer("can", can_data(500000, 100), kUp);
  for (int round = 0; round < 2000; ++round) {
    Bytes bytes = whole;
    bytes.resize(random() % (whole.size() + 1));
    for (int i = 0; i < 3 && !bytes.empty(); ++i) {
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    }
    parse_can_link(bytes);
  }
}

TEST(CanLink, IsChecked) {
  CanLink link;
  EXPECT_THAT(check_can_link("can0", std::nullopt).text, HasSubstr("there is no can0"));
  EXPECT_THAT(check_can_link("eth0", link).text, HasSubstr("eth0 is no CAN interface"));
  link.is_can = true;
  link.kind = "can";
  EXPECT_THAT(check_can_link("can0", link).text,
              AllOf(HasSubstr("is down"), HasSubstr("ip link set can0 up type can bitrate")));
  link.is_up = true;
  link.bit_rate = 250000;
  EXPECT_THAT(check_can_link("can0", link).text,
              AllOf(HasSubstr("stays off the bus"), HasSubstr("bitrate 250000 restart-ms")));
  link.restart_ms = 100;
  const Finding good = check_can_link("can0", link);
  EXPECT_EQ(good.verdict, Verdict::ok);
  EXPECT_THAT(good.text, HasSubstr("250000 bit/s"));
  link.kind = "vcan";
  EXPECT_EQ(check_can_link("vcan0", link).verdict, Verdict::ok);
}

TEST(CanTraffic, IsChecked) {
  CanTraffic traffic;
  traffic.seconds = 2;
  EXPECT_THAT(check_can_traffic("can0", 0x1A0, traffic).text, HasSubstr("no frame on can0 in 2 s"));
  traffic.others = 5;
  traffic.other_id = 0x123;
  EXPECT_THAT(check_can_traffic("can0", 0x1A0, traffic).text,
              AllOf(HasSubstr("encoder.can_id = 0x1A0"), HasSubstr("5 others, as 0x123")));
  traffic.wanted = 200;
  const Finding good = check_can_traffic("can0", 0x1A0, traffic);
  EXPECT_EQ(good.verdict, Verdict::ok);
  EXPECT_THAT(good.text, HasSubstr("100 frames a second"));
  traffic.bus_advice = "look at the cable";
  EXPECT_EQ(check_can_traffic("can0", 0x1A0, traffic).verdict, Verdict::wrong);
}

}  // namespace
}  // namespace scree
