#include "scree/drivers/velodyne/logged_packets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "unit/velodyne/packet_builder.hpp"

namespace scree::velodyne {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ByteVector = std::vector<std::uint8_t>;

ByteVector data_packet() {
  const auto packet = PacketBuilder().bytes();
  return {packet.begin(), packet.end()};
}

/// Parts of a message one behind the other.
ByteVector joined(const std::vector<ByteVector>& parts) {
  ByteVector all;
  for (const ByteVector& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::vector<ByteVector> packets_in(const ByteVector& message) {
  std::vector<ByteVector> packets;
  Bytes rest = message;
  while (!rest.empty()) {
    const Bytes packet = take_logged_packet(rest);
    if (!packet.empty()) packets.emplace_back(packet.begin(), packet.end());
  }
  return packets;
}

const ByteVector kFingerprint = {1, 2, 3, 4, 5, 6, 7, 8};
const ByteVector kTime = {0, 0, 0, 9, 9, 9, 9, 9};
const ByteVector kDataLength = {0, 0, 0x04, 0xB6};
const ByteVector kPositionLength = {0, 0, 0x02, 0x00};

TEST(LoggedPackets, AMessageMayBeThePacket) {
  EXPECT_THAT(packets_in(data_packet()), ElementsAre(data_packet()));
  const ByteVector position(512, 1), garbled(1206, 1);
  EXPECT_THAT(packets_in(position), ElementsAre(position));
  EXPECT_THAT(packets_in(garbled), ElementsAre(garbled));
}

TEST(LoggedPackets, OrHaveItBehindTimeAndLength) {
  const ByteVector position(512, 1), garbled(1206, 1);
  const auto logged = [](const ByteVector& length, const ByteVector& packet) {
    return joined({kFingerprint, kTime, length, packet});
  };
  EXPECT_THAT(packets_in(logged(kDataLength, data_packet())), ElementsAre(data_packet()));
  EXPECT_THAT(packets_in(logged(kDataLength, garbled)), ElementsAre(garbled));
  EXPECT_THAT(packets_in(logged(kPositionLength, position)), ElementsAre(position));
}

TEST(LoggedPackets, OrSeveralOfThem) {
  const ByteVector count = {0, 0, 0, 2};
  ByteVector other = data_packet();
  other[kTimestampOffset] ^= 1;
  const ByteVector list = joined({kFingerprint,
                                  kTime,
                                  count,
                                  kTime,
                                  kDataLength,
                                  data_packet(),
                                  kTime,
                                  kDataLength,
                                  other,
                                  {0, 0, 0}});
  EXPECT_THAT(packets_in(list), ElementsAre(data_packet(), other));
}

TEST(LoggedPackets, OtherMessagesHaveNone) {
  EXPECT_THAT(packets_in({}), IsEmpty());
  EXPECT_THAT(packets_in(kFingerprint), IsEmpty());
  EXPECT_THAT(packets_in(ByteVector(513, 0)), IsEmpty());
  EXPECT_THAT(packets_in(ByteVector(100'000, 0xFF)), IsEmpty());
  ByteVector cut = data_packet();
  cut.pop_back();
  EXPECT_THAT(packets_in(cut), IsEmpty());
}

TEST(LoggedPackets, SurviveAnyBytes) {
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    ByteVector message = joined({kFingerprint, kDataLength, data_packet(), data_packet()});
    message.resize(random() % (message.size() + 50));
    for (int i = 0; i < 4 && !message.empty(); ++i) {
      message[random() % message.size()] = static_cast<std::uint8_t>(random());
    }
    for (const ByteVector& packet : packets_in(message)) {
      EXPECT_TRUE(packet.size() == kDataPacketSize || packet.size() == kPositionPacketSize);
    }
  }
}

}  // namespace
}  // namespace scree::velodyne
