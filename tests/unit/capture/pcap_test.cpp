#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "scree/capture/capture.hpp"
#include "scree/capture/pcap_reader.hpp"
#include "scree/capture/pcap_writer.hpp"
#include "scree/core/nanoseconds.hpp"
#include "unit/capture/pcap_files.hpp"
#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

using ::testing::HasSubstr;

TEST(Pcap, WhatIsWrittenReadsBackToTheNanosecond) {
  const TemporaryFolder folder;
  write_packets(folder / "lidar.pcap", 5);
  const Read read = read_all(folder / "lidar.pcap");
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.broken_off, "");
  ASSERT_EQ(read.payloads.size(), 5U);
  EXPECT_EQ(read.arrival_ns[4], 1'598'612'523'000'000'005);
  EXPECT_EQ(read.payloads[3], std::vector<std::uint8_t>(1209, 3));
}

TEST(Pcap, TimesAfter2038AreNotThoseBefore1970) {
  const TemporaryFolder folder;
  for (const std::int64_t seconds : {0x7FFFFFFFLL, 0x80000000LL, 0xFFFFFFFFLL}) {
    write_packets(folder / "lidar.pcap", 2, seconds * kSecond);
    const Read read = read_all(folder / "lidar.pcap");
    EXPECT_EQ(read.broken_off, "");
    EXPECT_EQ(read.arrival_ns, (std::vector{seconds * kSecond, seconds * kSecond + 1}));
  }
}

std::uint32_t sum_of_words(const std::vector<std::uint8_t>& bytes, std::size_t begin,
                           std::size_t end, std::uint32_t sum) {
  for (std::size_t i = begin; i < end; ++i) sum += i % 2 == begin % 2 ? bytes[i] * 256U : bytes[i];
  while (sum > 0xFFFF) sum = (sum & 0xFFFF) + (sum >> 16);
  return sum;
}

TEST(Pcap, ChecksumsAreRight) {
  const TemporaryFolder folder;
  write_packets(folder / "lidar.pcap", 2);
  auto reader = PcapReader::open(folder / "lidar.pcap");
  ASSERT_TRUE(reader);
  PcapRecord record;
  while (reader->next(record)) {
    const std::vector<std::uint8_t> frame(record.bytes.begin(), record.bytes.end());
    EXPECT_EQ(sum_of_words(frame, 14, 34, 0), 0xFFFFU);
    const auto length = static_cast<std::uint32_t>(frame.size() - 34);
    EXPECT_EQ(sum_of_words(frame, 34, frame.size(), sum_of_words(frame, 26, 34, 17 + length)),
              0xFFFFU);
  }
}

TEST(Pcap, SerialRecordsKeepTheirBytes) {
  const TemporaryFolder folder;
  auto writer = PcapWriter::create_serial(folder / "imu.pcap");
  ASSERT_TRUE(writer);
  const std::vector<std::uint8_t> bytes = {0xFA, 0xFF, 0x36};
  writer->write(42, bytes);
  ASSERT_TRUE(writer->close());
  auto reader = PcapReader::open(folder / "imu.pcap");
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->link_type(), 147);
  PcapRecord record;
  ASSERT_TRUE(reader->next(record));
  EXPECT_EQ(record.arrival_ns, 42);
  EXPECT_TRUE(std::ranges::equal(record.bytes, bytes));
  EXPECT_FALSE(reader->next(record));
}

TEST(Pcap, CopiedRecordsStayAsTheyAre) {
  const TemporaryFolder folder;
  write_packets(folder / "whole.pcap", 3);
  auto reader = PcapReader::open(folder / "whole.pcap");
  ASSERT_TRUE(reader);
  auto writer = PcapWriter::create_like(folder / "copy.pcap", *reader);
  ASSERT_TRUE(writer);
  for (PcapRecord record; reader->next(record);) writer->write(record);
  ASSERT_TRUE(writer->close());
  EXPECT_EQ(bytes_of(folder / "copy.pcap"), bytes_of(folder / "whole.pcap"));
}

TEST(Pcap, AFileCutInTheMiddleGivesEverythingBefore) {
  const TemporaryFolder folder;
  write_packets(folder / "whole.pcap", 5);
  const std::string whole = bytes_of(folder / "whole.pcap");
  const Read read = read_all(folder.write("cut.pcap", whole.substr(0, whole.size() - 100)));
  EXPECT_EQ(read.payloads.size(), 4U);
  EXPECT_THAT(read.broken_off, HasSubstr("cut.pcap: breaks off: "));
}

TEST(Pcap, WhatIsNoCaptureIsOneSentence) {
  const TemporaryFolder folder;
  EXPECT_THAT(read_all(folder / "none.pcap").error, HasSubstr("none.pcap: no such file"));
  EXPECT_THAT(read_all(folder.write("empty.pcap", "")).error, HasSubstr("is empty"));
  EXPECT_THAT(read_all(folder.write("foreign.pcap", "%PDF-1.7 and so on and on and on")).error,
              HasSubstr("cannot be read as a pcap or pcapng file"));
  EXPECT_THAT(read_all("/tmp").error, HasSubstr("is no regular file"));
}

TEST(Pcap, SnapLengthIsCounted) {
  const TemporaryFolder folder;
  write_packets(folder / "whole.pcap", 1);
  std::string bytes = bytes_of(folder / "whole.pcap");
  constexpr std::size_t kFileHeader = 24, kCapturedSize = kFileHeader + 8;
  bytes[kCapturedSize] = 96, bytes[kCapturedSize + 1] = 0;
  bytes.resize(kFileHeader + 16 + 96);
  const Read read = read_all(folder.write("snapped.pcap", bytes));
  EXPECT_EQ(read.payloads.size(), 0U);
  EXPECT_EQ(read.frames.truncated, 1U);
  EXPECT_EQ(read.broken_off, "");
}

TEST(Pcap, ReadsBothByteOrdersAndPrecisionsAndPcapng) {
  const TemporaryFolder folder;
  write_packets(folder / "whole.pcap", 1);
  const std::string frame = bytes_of(folder / "whole.pcap").substr(24 + 16);
  for (const bool big : {false, true}) {
    for (const bool nano : {false, true}) {
      std::string bytes;
      append(bytes, nano ? 0xA1B23C4D : 0xA1B2C3D4, 4, big);
      append(bytes, 2, 2, big), append(bytes, 4, 2, big);
      append(bytes, 0, 4, big), append(bytes, 0, 4, big);
      append(bytes, 65535, 4, big), append(bytes, 1, 4, big);
      append(bytes, 1'598'612'523, 4, big), append(bytes, 123'456, 4, big);
      append(bytes, frame.size(), 4, big), append(bytes, frame.size(), 4, big);
      const Read read = read_all(folder.write("file.pcap", bytes + frame));
      ASSERT_EQ(read.arrival_ns.size(), 1U) << read.error << read.broken_off;
      EXPECT_EQ(read.arrival_ns[0],
                1'598'612'523'000'000'000 + std::int64_t{123'456} * (nano ? 1 : 1000));
    }
    std::string bytes;
    const auto block = [&](std::uint32_t type, const std::string& body) {
      append(bytes, type, 4, big), append(bytes, body.size() + 12, 4, big);
      bytes += body;
      append(bytes, body.size() + 12, 4, big);
    };
    std::string section, interface, packet;
    append(section, 0x1A2B3C4D, 4, big), append(section, 1, 2, big), append(section, 0, 2, big);
    append(section, ~std::uint64_t{0}, 8, big);
    append(interface, 1, 2, big), append(interface, 0, 2, big), append(interface, 0, 4, big);
    append(interface, 9, 2, big), append(interface, 1, 2, big);  // times in nanoseconds
    append(interface, 9, 1, big), append(interface, 0, 3, big), append(interface, 0, 4, big);
    const std::uint64_t time = 1'598'612'523'123'456'789;
    append(packet, 0, 4, big), append(packet, time >> 32, 4, big);
    append(packet, time & 0xFFFFFFFF, 4, big);
    append(packet, frame.size(), 4, big), append(packet, frame.size(), 4, big);
    packet += frame;
    packet.resize((packet.size() + 3) / 4 * 4);
    block(0x0A0D0D0A, section), block(1, interface), block(6, packet);
    const Read read = read_all(folder.write("file.pcapng", bytes));
    ASSERT_EQ(read.arrival_ns.size(), 1U) << read.error << read.broken_off;
    EXPECT_EQ(read.arrival_ns[0], static_cast<std::int64_t>(time));
  }
}

/// The fragments of an Ethernet frame's IPv4 packet, `size` bytes of payload each.
std::vector<std::string> fragments_of(const std::string& frame, std::size_t size) {
  const std::string header = frame.substr(0, 34), payload = frame.substr(34);
  std::vector<std::string> fragments;
  for (std::size_t at = 0; at < payload.size(); at += size) {
    std::string fragment = header + payload.substr(at, size);
    const std::size_t length = fragment.size() - 14;
    const bool is_last = at + size >= payload.size();
    const std::size_t flags = at / 8 | (is_last ? 0U : 0x2000U);
    fragment[16] = static_cast<char>(length >> 8), fragment[17] = static_cast<char>(length);
    fragment[20] = static_cast<char>(flags >> 8), fragment[21] = static_cast<char>(flags);
    fragments.push_back(fragment);
  }
  return fragments;
}

TEST(Pcap, FragmentsArePutTogetherInAnyOrder) {
  const TemporaryFolder folder;
  auto pieces = fragments_of(frame_of_a_packet(folder), 400);
  ASSERT_EQ(pieces.size(), 4U);
  std::ranges::sort(pieces);
  do {
    PcapngText file;
    file.interface(1, 0, 6);
    for (const std::string& piece : pieces) file.packet(0, 5, piece);
    file.packet(0, 6, pieces.front());
    const Read read = read_all(folder.write("fragments.pcapng", file.bytes));
    ASSERT_EQ(read.payloads.size(), 1U);
    EXPECT_EQ(read.payloads[0], std::vector<std::uint8_t>(1206, 0));
    EXPECT_EQ(read.arrival_ns[0], 5000);
    EXPECT_EQ(read.frames.fragments, 1U) << "of a datagram whose rest does not come";
  } while (std::ranges::next_permutation(pieces).found);
}

TEST(Pcap, APackedFileIsNamed) {
  const TemporaryFolder folder;
  EXPECT_THAT(read_all(folder.write("a.pcap.gz", "\x1F\x8B\x08 and more")).error,
              HasSubstr("a.pcap.gz: is packed with gzip: unpack it first"));
  EXPECT_EQ(packed_with(folder.write("b", "(\xB5/\xFD")), "zstd");
  EXPECT_EQ(packed_with(folder / "none"), "");
}

TEST(Pcap, SurvivesGarbledFiles) {
  const TemporaryFolder folder;
  write_packets(folder / "whole.pcap", 4);
  const std::string whole = bytes_of(folder / "whole.pcap");
  std::mt19937 random(5);
  for (int round = 0; round < 500; ++round) {
    std::string bytes = whole.substr(0, random() % 3 == 0 ? random() % whole.size() : whole.size());
    for (int flips = 0; flips < 5 && !bytes.empty(); ++flips) {
      const std::size_t where = random() % 2 == 0 ? random() % bytes.size() : random() % 60;
      bytes[std::min(where, bytes.size() - 1)] = static_cast<char>(random());
    }
    const Read read = read_all(folder.write("garbled.pcap", bytes));
    ASSERT_LE(read.payloads.size(), 100U);
  }
}

TEST(Capture, AFolderHasItsFilesAndItsConfiguration) {
  const TemporaryFolder folder;
  EXPECT_THAT(lidar_file(folder / "").error().message, HasSubstr("has no lidar.pcap"));
  EXPECT_THAT(lidar_file(folder / "none").error().message, HasSubstr("no such file or folder"));
  folder.write("lidar.pcapng", "");
  EXPECT_EQ(lidar_file(folder / "").value(), folder / "lidar.pcapng");
  folder.write("lidar.pcap", "");
  EXPECT_EQ(lidar_file(folder / "").value(), folder / "lidar.pcap");
  EXPECT_EQ(lidar_file(folder / "lidar.pcapng").value(), folder / "lidar.pcapng");

  EXPECT_EQ(settings_file(folder / "", {}), std::nullopt);
  folder.write("scree.toml", "");
  EXPECT_EQ(settings_file(folder / "", {}), folder / "scree.toml");
  EXPECT_EQ(settings_file(folder / "", "robot.toml"), "robot.toml");
  EXPECT_EQ(settings_file(folder / "lidar.pcap", {}), std::nullopt);
}

}  // namespace
}  // namespace scree
