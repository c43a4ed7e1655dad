#include "scree/drivers/velodyne/position_packet.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace scree::velodyne {
namespace {

std::vector<std::uint8_t> packet(std::uint32_t timestamp, std::uint8_t pps,
                                 const std::string& nmea) {
  std::vector<std::uint8_t> bytes(kPositionPacketSize, 0);
  std::memcpy(bytes.data() + kPositionTimestampOffset, &timestamp, 4);
  bytes[kPpsStatusOffset] = pps;
  std::memcpy(bytes.data() + kNmeaOffset, nmea.data(), nmea.size());
  return bytes;
}

constexpr const char* kFix =
    "$GPRMC,110204,A,2426.2500,N,11805.7900,E,001.1,087.0,280820,003.1,W,A*04";

TEST(PositionPacket, ReadsTimePulseAndSentence) {
  const auto bytes = packet(123'456'789, 2, std::string(kFix) + "\r\n");
  const auto position = parse_position_packet(bytes);
  ASSERT_TRUE(position);
  EXPECT_EQ(position->timestamp_us, 123'456'789U);
  EXPECT_EQ(position->pps, PpsStatus::locked);
  EXPECT_EQ(position->sentence, kFix);
  ASSERT_TRUE(position->gprmc);
  EXPECT_TRUE(position->gprmc->fix);
  EXPECT_EQ(position->gprmc->utc_ns, 1'598'612'524'000'000'000);  // 2020-08-28 11:02:04
  EXPECT_NEAR(position->gprmc->latitude_deg.value(), 24.4375, 1e-9);
  EXPECT_NEAR(position->gprmc->longitude_deg.value(), 118.0965, 1e-9);
}

TEST(PositionPacket, NoReceiverIsNoSentence) {
  const auto position = parse_position_packet(packet(5, 0, ""));
  ASSERT_TRUE(position);
  EXPECT_EQ(position->pps, PpsStatus::absent);
  EXPECT_TRUE(position->sentence.empty());
  EXPECT_FALSE(position->gprmc);
  EXPECT_FALSE(parse_position_packet(packet(5, 4, ""))->pps);
}

TEST(PositionPacket, OtherSizesAreNone) {
  EXPECT_FALSE(parse_position_packet(std::vector<std::uint8_t>(511)));
  EXPECT_FALSE(parse_position_packet(std::vector<std::uint8_t>(1206)));
  EXPECT_FALSE(parse_position_packet({}));
}

std::string with_checksum(const std::string& text) {
  unsigned sum = 0;
  for (const char c : text) sum ^= static_cast<unsigned char>(c);
  constexpr const char* kDigits = "0123456789ABCDEF";
  return "$" + text + "*" + kDigits[sum / 16] + kDigits[sum % 16];
}

TEST(Gprmc, NeedsItsChecksum) {
  EXPECT_TRUE(parse_gprmc(kFix));
  std::string wrong = kFix;
  wrong[10] = '5';
  EXPECT_FALSE(parse_gprmc(wrong));
  EXPECT_FALSE(parse_gprmc(std::string(kFix).substr(0, 71)));
  EXPECT_FALSE(parse_gprmc("$GPRMC,110204,A"));
  EXPECT_FALSE(parse_gprmc(""));
  EXPECT_FALSE(parse_gprmc(with_checksum("GPGGA,110204")));
}

TEST(Gprmc, LeavesOutWhatMakesNoSense) {
  const auto empty = parse_gprmc(with_checksum("GPRMC,,V,,,,,,,,,,N"));
  ASSERT_TRUE(empty);
  EXPECT_FALSE(empty->fix || empty->utc_ns || empty->latitude_deg || empty->longitude_deg);
  const auto odd = parse_gprmc(with_checksum("GPRMC,250000,A,9999.0,N,1e400,E,,,310220"));
  ASSERT_TRUE(odd);
  EXPECT_TRUE(odd->fix);
  EXPECT_FALSE(odd->utc_ns || odd->latitude_deg || odd->longitude_deg);
  const auto south = parse_gprmc(with_checksum("GPRMC,000000.50,A,3330.0,S,07040.0,W,,,010124"));
  EXPECT_NEAR(south->latitude_deg.value(), -33.5, 1e-9);
  EXPECT_NEAR(south->longitude_deg.value(), -70.0 - 2.0 / 3.0, 1e-9);
  EXPECT_EQ(south->utc_ns, 1'704'067'200'500'000'000);
}

TEST(PositionPacket, SurvivesAnyBytes) {
  std::mt19937 random(2);
  for (int round = 0; round < 20000; ++round) {
    auto bytes = packet(1, 2, std::string(kFix) + "\r\n");
    for (int flips = 0; flips < 5; ++flips) {
      bytes[kNmeaOffset + random() % 80] = static_cast<std::uint8_t>(random());
    }
    ASSERT_TRUE(parse_position_packet(bytes));
    std::string text = "GPRMC,110204,A,2426.2500,N,11805.7900,E,001.1,087.0,280820,003.1,W,A";
    for (int flips = 0; flips < 3; ++flips)
      text[random() % text.size()] = static_cast<char>(random());
    (void)parse_gprmc(with_checksum(text));
  }
}

}  // namespace
}  // namespace scree::velodyne
