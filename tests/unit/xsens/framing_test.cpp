#include "scree/drivers/xsens/framing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "unit/allocation_counter.hpp"
#include "unit/xsens/message_builder.hpp"

namespace scree::xsens {
namespace {

using test::ByteVector;
using test::joined;
using test::message;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;

struct Found {
  std::vector<ByteVector> data;
  std::vector<int> ids;
  std::vector<std::size_t> behind;

  void operator()(const Message& message) {
    data.emplace_back(message.data.begin(), message.data.end());
    ids.push_back(static_cast<int>(message.id));
    behind.push_back(message.bytes_behind);
  }
};

ByteVector numbers(std::size_t count) {
  ByteVector bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::uint8_t>(i * 7);
  return bytes;
}

TEST(Framing, FindsMessagesSplitAtEveryByte) {
  const ByteVector stream =
      joined({message(0x36, numbers(20)), message(0x3E, {}), message(0x36, numbers(300))});
  for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
    Framer framer;
    Found found;
    framer.take(Bytes(stream).first(cut), found);
    framer.take(Bytes(stream).subspan(cut), found);
    ASSERT_THAT(found.ids, ElementsAre(0x36, 0x3E, 0x36)) << cut;
    EXPECT_EQ(found.data[0], numbers(20));
    EXPECT_TRUE(found.data[1].empty());
    EXPECT_EQ(found.data[2], numbers(300));
    EXPECT_EQ(framer.counters().bytes_skipped, 0U);
  }
  Framer framer;
  Found found;
  for (const std::uint8_t& byte : stream) framer.take(Bytes(&byte, 1), found);
  EXPECT_THAT(found.ids, ElementsAre(0x36, 0x3E, 0x36));
}

TEST(Framing, SaysHowManyBytesOfTheReadLieBehind) {
  const ByteVector stream = joined({message(1, numbers(10)), message(2, numbers(1500))});
  const std::size_t second = stream.size() - 15;
  ByteVector read = stream;
  for (int i = 0; i < 3; ++i) read.insert(read.end(), stream.begin(), stream.end());
  read.insert(read.end(), 7, 0);
  Framer framer;
  Found found;
  framer.take(read, found);
  std::vector<std::size_t> expected;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t rest = (3 - i) * stream.size() + 7;
    expected.push_back(rest + second);
    expected.push_back(rest);
  }
  EXPECT_THAT(found.behind, ElementsAreArray(expected));
}

TEST(Framing, LengthsUpTo2048AreRead) {
  for (const std::size_t length : {0U, 1U, 253U, 254U, 255U, 256U, 2047U, 2048U}) {
    Framer framer;
    Found found;
    framer.take(message(0x36, numbers(length)), found);
    ASSERT_EQ(found.data.size(), 1U) << length;
    EXPECT_EQ(found.data[0], numbers(length));
  }
  // The long form of a short length is unusual and right.
  Framer framer;
  Found found;
  framer.take(message(0x36, numbers(9), true), found);
  ASSERT_EQ(found.data.size(), 1U);
  EXPECT_EQ(found.data[0], numbers(9));
}

TEST(Framing, LongerOnesAreRefusedAtOnce) {
  Framer framer;
  Found found;
  const ByteVector stream =
      joined({{0xFA, 0xFF, 0x36, 0xFF, 0x08, 0x01}, message(0x36, numbers(5))});
  framer.take(stream, found);
  EXPECT_EQ(framer.counters().length, 1U);
  EXPECT_EQ(found.data.size(), 1U);
  EXPECT_EQ(framer.counters().bytes_skipped, 6U);
}

TEST(Framing, AWrongChecksumCostsThatMessageOnly) {
  const ByteVector good = message(0x36, numbers(40));
  for (std::size_t i = 2; i < good.size(); ++i) {
    if (i == 3) continue;  // a wrong length is another test
    ByteVector bad = good;
    bad[i] ^= 0x10U;
    Framer framer;
    Found found;
    framer.take(joined({good, bad, good}), found);
    EXPECT_EQ(found.data.size(), 2U) << i;
    EXPECT_EQ(framer.counters().checksum, 1U) << i;
    EXPECT_EQ(framer.counters().bytes_skipped, good.size());
  }
}

TEST(Framing, AFalsePreambleHidesNoMessage) {
  const ByteVector good = message(0x36, numbers(40));
  // Each claims to be a message that reaches into, or beyond, the true ones.
  for (const ByteVector& garbage :
       {ByteVector{0xFA}, ByteVector{0xFA, 0xFF}, ByteVector{0xFA, 0xFA, 0xFA},
        ByteVector{0xFA, 0xFF, 0x36}, ByteVector{0xFA, 0xFF, 0x36, 10},
        ByteVector{0xFA, 0xFF, 0x36, 0xFE}, ByteVector{0xFA, 0xFF, 0x36, 0xFF},
        ByteVector{0xFA, 0xFF, 0x36, 0xFF, 0x07, 0xFF}, ByteVector{0xFA, 0x01, 0x36, 5},
        numbers(200)}) {
    Framer framer;
    Found found;
    const ByteVector stream = joined({good, garbage, good, good});
    framer.take(stream, found);
    framer.flush(found);
    EXPECT_EQ(found.data.size(), 3U) << ::testing::PrintToString(garbage);
    EXPECT_EQ(framer.counters().bytes_skipped, garbage.size());
    // It is found without the end of the stream too, when enough follows.
    Framer live;
    Found later;
    live.take(stream, later);
    for (int i = 0; i < 60; ++i) live.take(good, later);
    EXPECT_EQ(later.data.size(), 63U) << ::testing::PrintToString(garbage);
  }
}

TEST(Framing, NoByteIsLostOrCountedTwice) {
  std::mt19937 random(5);
  const ByteVector good = message(0x36, numbers(30));
  // Mostly bytes that look like headers, so that false messages are many.
  constexpr std::uint8_t kLikely[] = {0xFA, 0xFF, 0x36, 0x00, 0x05, 0x07};
  Framer framer;
  std::size_t taken = 0, in_messages = 0, whole = 0;
  const auto count = [&](const Message& message) {
    in_messages += message.size;
    whole += ByteVector(message.data.begin(), message.data.end()) == numbers(30) ? 1U : 0U;
  };
  std::size_t sent = 0;
  for (int round = 0; round < 4000; ++round) {
    ByteVector bytes(random() % 40);
    for (std::uint8_t& byte : bytes) {
      byte = random() % 3 == 0 ? static_cast<std::uint8_t>(random()) : kLikely[random() % 6];
    }
    if (random() % 2 == 0) {
      bytes.insert(bytes.end(), good.begin(), good.end());
      ++sent;
    }
    taken += bytes.size();
    framer.take(bytes, count);
  }
  framer.flush(count);
  EXPECT_EQ(taken, in_messages + framer.counters().bytes_skipped);
  EXPECT_GT(framer.counters().checksum, 100U);
  EXPECT_GT(framer.counters().length, 10U);
  // One false message in 256 has the right sum by chance and may take a true one with it.
  EXPECT_GT(whole, sent * 95 / 100);
  EXPECT_LE(whole, sent);
}

TEST(Framing, TakesNoMemory) {
  const ByteVector stream = joined({message(0x36, numbers(2000)), numbers(500)});
  Framer framer;
  std::size_t messages = 0;
  const std::size_t before = test::allocations();
  for (int i = 0; i < 50; ++i) framer.take(stream, [&](const Message&) { ++messages; });
  EXPECT_EQ(test::allocations(), before);
  EXPECT_EQ(messages, 50U);
}

}  // namespace
}  // namespace scree::xsens
