#include "scree/capture/datagram.hpp"

#include <gtest/gtest.h>
#include <pcap/dlt.h>

#include <random>
#include <vector>

#include "scree/core/ipv4.hpp"

namespace scree {
namespace {

using Frame = std::vector<std::uint8_t>;

Frame operator+(Frame a, const Frame& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// 192.168.1.201:443 to port 2368, payload 1 2 3, with `options` words of IP options.
Frame ip_packet(std::uint8_t options = 0) {
  Frame ip = {static_cast<std::uint8_t>(0x45 + options),
              0,
              0,
              static_cast<std::uint8_t>(31 + 4 * options),
              0,
              0,
              0x40,
              0,
              64,
              17,
              0,
              0,
              192,
              168,
              1,
              201,
              255,
              255,
              255,
              255};
  ip.insert(ip.end(), std::size_t{4} * options, 1);
  return ip + Frame{0x01, 0xBB, 0x09, 0x40, 0, 11, 0, 0, 1, 2, 3};
}

FrameKind parse(int link_type, const Frame& frame, Datagram& datagram, std::size_t cut_off = 0) {
  return parse_frame(link_type, frame, frame.size() + cut_off, datagram);
}

void expect_found(int link_type, const Frame& frame) {
  SCOPED_TRACE(link_type);
  Datagram datagram;
  ASSERT_EQ(parse(link_type, frame, datagram), FrameKind::udp);
  EXPECT_EQ(ipv4_text(datagram.source), "192.168.1.201");
  EXPECT_EQ(datagram.source_port, 443);
  EXPECT_EQ(datagram.destination_port, 2368);
  EXPECT_EQ(Frame(datagram.payload.begin(), datagram.payload.end()), (Frame{1, 2, 3}));
}

const Frame kMac(12, 0xAA);

TEST(ParseFrame, FindsTheDatagramBehindEveryLinkHeader) {
  const Frame padding(18, 0);
  expect_found(DLT_EN10MB, kMac + Frame{8, 0} + ip_packet());
  expect_found(DLT_EN10MB, kMac + Frame{8, 0} + ip_packet() + padding);
  expect_found(DLT_EN10MB, kMac + Frame{8, 0} + ip_packet(3));
  expect_found(DLT_EN10MB, kMac + Frame{0x81, 0, 0, 5, 8, 0} + ip_packet());
  expect_found(DLT_EN10MB, kMac + Frame{0x88, 0xA8, 0, 5, 0x81, 0, 0, 7, 8, 0} + ip_packet());
  expect_found(DLT_LINUX_SLL, Frame(14, 0) + Frame{8, 0} + ip_packet());
  expect_found(DLT_LINUX_SLL2, Frame{8, 0} + Frame(18, 0) + ip_packet());
  expect_found(DLT_RAW, ip_packet());
  expect_found(DLT_IPV4, ip_packet());
  expect_found(DLT_NULL, Frame{2, 0, 0, 0} + ip_packet());
  expect_found(DLT_LOOP, Frame{0, 0, 0, 2} + ip_packet());
}

TEST(ParseFrame, TellsWhatItIsNot) {
  Datagram datagram;
  Frame fragment = ip_packet();
  fragment[6] = 0x20;
  EXPECT_EQ(parse(DLT_RAW, fragment, datagram), FrameKind::fragment);
  fragment[6] = 0, fragment[7] = 1;
  EXPECT_EQ(parse(DLT_RAW, fragment, datagram), FrameKind::fragment);
  Frame tcp = ip_packet();
  tcp[9] = 6;
  EXPECT_EQ(parse(DLT_RAW, tcp, datagram), FrameKind::other);
  EXPECT_EQ(parse(DLT_EN10MB, kMac + Frame{0x86, 0xDD} + Frame(60, 0), datagram), FrameKind::other);
  EXPECT_EQ(parse(147, ip_packet(), datagram), FrameKind::other);
  Frame cut = ip_packet();
  cut.pop_back();
  EXPECT_EQ(parse(DLT_RAW, cut, datagram, 1), FrameKind::truncated);
  Frame longer = ip_packet();
  longer[25] = 200;
  EXPECT_EQ(parse(DLT_RAW, longer, datagram), FrameKind::truncated);
}

TEST(ParseFrame, SurvivesAnyBytes) {
  std::mt19937 random(3);
  const Frame good = kMac + Frame{0x81, 0, 0, 5, 8, 0} + ip_packet(2);
  for (int round = 0; round < 200000; ++round) {
    Frame frame = good;
    frame.resize(random() % (good.size() + 1));
    for (int flips = 0; flips < 4 && !frame.empty(); ++flips) {
      frame[random() % frame.size()] = static_cast<std::uint8_t>(random());
    }
    for (const int link : {DLT_EN10MB, DLT_LINUX_SLL, DLT_LINUX_SLL2, DLT_RAW, DLT_NULL}) {
      Datagram datagram;
      if (parse(link, frame, datagram) == FrameKind::udp && !datagram.payload.empty()) {
        ASSERT_LE(datagram.payload.data() + datagram.payload.size(), frame.data() + frame.size());
      }
    }
  }
}

}  // namespace
}  // namespace scree
