#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "unit/capture/pcap_files.hpp"

namespace scree {
namespace {

using ::testing::HasSubstr;

TEST(Pcap, InterfacesOfAPcapngFileMayDiffer) {
  const TemporaryFolder folder;
  const std::string ethernet = frame_of_a_packet(folder), ip = ethernet.substr(14);
  PcapngText file;
  file.interface(147, 0, 6);  // no network
  file.interface(1, 65535, 6);
  file.packet(1, 1'598'612'523'000'001, ethernet);
  file.interface(101, 262144, 9);  // LINKTYPE_RAW
  file.packet(2, 1'598'612'523'000'002'003, ip);
  file.block(0xBAD, "whatever");  // of a kind that is not known
  file.packet(0, 0, "serial bytes");
  file.interface(113, 64, 0x80 | 10);  // LINKTYPE_LINUX_SLL, 1024 units a second
  file.packet(3, 1'598'612'523ULL * 1024 + 512, std::string(14, '\0') + "\x08" + '\0' + ip);
  file.simple_packet("of the first interface");
  const Read read = read_all(folder.write("many.pcapng", file.bytes));
  EXPECT_EQ(read.broken_off, "");
  EXPECT_THAT(read.arrival_ns,
              testing::ElementsAre(1'598'612'523'000'001'000, 1'598'612'523'000'002'003,
                                   1'598'612'523'500'000'000));
  for (const auto& payload : read.payloads) EXPECT_EQ(payload.size(), 1206U);
  EXPECT_EQ(read.frames.other, 2U);
  EXPECT_EQ(PcapReader::open(folder / "many.pcapng")->link_type(), 1);
}

TEST(Pcap, APcapngFileMayBreakOffAnywhere) {
  const TemporaryFolder folder;
  PcapngText file;
  file.interface(1, 0, 6);
  file.packet(0, 1, frame_of_a_packet(folder));
  const std::string whole = file.bytes;
  for (std::size_t size = 4; size < whole.size(); size += 3) {
    const Read read = read_all(folder.write("cut.pcapng", whole.substr(0, size)));
    EXPECT_EQ(read.payloads.size(), 0U) << size;
  }
  EXPECT_THAT(read_all(folder.write("cut.pcapng", whole.substr(0, whole.size() - 9))).broken_off,
              HasSubstr("cut.pcapng: breaks off: a block is cut"));
  constexpr std::size_t kSection = 28;  // bytes
  EXPECT_THAT(read_all(folder.write("cut.pcapng", whole.substr(0, kSection + 5))).error,
              HasSubstr("cut.pcapng: breaks off before its first packet: a block is cut"));
  EXPECT_THAT(read_all(folder.write("bare.pcapng", whole.substr(0, kSection))).error,
              HasSubstr("bare.pcapng: describes no interface"));
  file.packet(7, 1, "of an interface that is not there");
  EXPECT_THAT(read_all(folder.write("odd.pcapng", file.bytes)).broken_off,
              HasSubstr("of no interface"));
  std::mt19937 random(6);
  for (int round = 0; round < 300; ++round) {
    std::string bytes = whole;
    for (int flips = 0; flips < 4; ++flips) {
      bytes[4 + random() % 90] = static_cast<char>(random());
    }
    ASSERT_LE(read_all(folder.write("garbled.pcapng", bytes)).payloads.size(), 1U);
  }
}

}  // namespace
}  // namespace scree
