#include "scree/drivers/encoder/signal.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "simulator/encoder.hpp"

namespace scree::encoder {
namespace {

EncoderSettings layout_of(ByteOrder order, int start, int length, bool is_signed) {
  EncoderSettings layout;
  layout.byte_order = order;
  layout.start_bit = start;
  layout.length = length;
  layout.is_signed = is_signed;
  return layout;
}

constexpr auto kLittle = ByteOrder::little_endian;
constexpr auto kBig = ByteOrder::big_endian;
constexpr std::array<std::uint8_t, 8> kBytes = {0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC, 0xDE, 0xF0};

std::optional<std::int64_t> read(ByteOrder order, int start, int length, bool is_signed = false) {
  return read_signal(layout_of(order, start, length, is_signed), kBytes);
}

TEST(ReadSignal, LittleEndianRunsUpwards) {
  EXPECT_EQ(read(kLittle, 0, 8), 0x12);
  EXPECT_EQ(read(kLittle, 0, 16), 0x3412);
  EXPECT_EQ(read(kLittle, 4, 8), 0x41);
  EXPECT_EQ(read(kLittle, 12, 20), 0x78563);
  EXPECT_EQ(read(kLittle, 63, 1), 1);
}

TEST(ReadSignal, BigEndianRunsDownAndOnInTheNextByte) {
  EXPECT_EQ(read(kBig, 7, 8), 0x12);
  EXPECT_EQ(read(kBig, 7, 16), 0x1234);
  EXPECT_EQ(read(kBig, 3, 8), 0x23);
  EXPECT_EQ(read(kBig, 11, 12), 0x456);
  EXPECT_EQ(read(kBig, 56, 1), 0);
  EXPECT_EQ(read(kBig, 63, 1), 1);
}

TEST(ReadSignal, TheHighestBitIsTheSignOfASignedOne) {
  EXPECT_EQ(read(kLittle, 32, 8), 0x9A);
  EXPECT_EQ(read(kLittle, 32, 8, true), 0x9A - 0x100);
  EXPECT_EQ(read(kLittle, 0, 8, true), 0x12);
  EXPECT_EQ(read(kBig, 39, 12, true), 0x9AB - 0x1000);
  EXPECT_EQ(read(kBig, 63, 1, true), -1);
  EXPECT_EQ(read(kLittle, 0, 64, true), static_cast<std::int64_t>(0xF0DEBC9A78563412));
  EXPECT_EQ(read(kBig, 7, 64), 0x123456789ABCDEF0);
}

TEST(ReadSignal, AFrameThatEndsBeforeTheSignalHasNone) {
  for (const auto& [order, start, length, bytes] : {std::tuple{kLittle, 0, 8, 1},
                                                    {kLittle, 0, 9, 2},
                                                    {kLittle, 7, 1, 1},
                                                    {kLittle, 7, 2, 2},
                                                    {kLittle, 12, 20, 4},
                                                    {kLittle, 448, 64, 64},
                                                    {kBig, 7, 8, 1},
                                                    {kBig, 7, 9, 2},
                                                    {kBig, 0, 1, 1},
                                                    {kBig, 0, 2, 2},
                                                    {kBig, 0, 9, 2},
                                                    {kBig, 0, 10, 3},
                                                    {kBig, 11, 12, 3},
                                                    {kBig, 455, 64, 64}}) {
    const EncoderSettings layout = layout_of(order, start, length, false);
    const std::vector<std::uint8_t> data(64, 0xFF);
    const auto size = static_cast<std::size_t>(bytes);
    EXPECT_EQ(layout.frame_bytes(), bytes) << start << ' ' << length;
    EXPECT_TRUE(read_signal(layout, std::span(data).first(size))) << start << ' ' << length;
    EXPECT_FALSE(read_signal(layout, std::span(data).first(size - 1))) << start << ' ' << length;
  }
}

/// What the simulator writes, in every place.
TEST(ReadSignal, ReadsWhatTheSimulatorWrites) {
  std::mt19937_64 random(1);
  int tried = 0;
  for (int start = 0; start < 64; ++start) {
    for (int length = 1; length <= 64; ++length) {
      for (const ByteOrder order : {kLittle, kBig}) {
        const EncoderSettings layout = layout_of(order, start, length, true);
        if (layout.frame_bytes() > 8) continue;
        CanData data;
        for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random());
        const auto unused = static_cast<unsigned>(64 - length);
        const std::int64_t value = static_cast<std::int64_t>(random()) >> unused;
        put_signal(data, layout, value);
        ASSERT_EQ(read_signal(layout, data), value) << start << ' ' << length;
        ++tried;
      }
    }
  }
  EXPECT_GT(tried, 2000);
}

TEST(Scaled, IsFactorOffsetAndScale) {
  EncoderSettings layout = layout_of(kLittle, 0, 64, true);
  layout.scale = 0.5;
  EXPECT_EQ(scaled(layout, -3), -1.5);
  layout.factor = 0.01;
  layout.offset = -20;
  EXPECT_DOUBLE_EQ(scaled(layout, 4000), 10);
  EXPECT_DOUBLE_EQ(quantum(layout), 0.005);
  layout.is_signed = false;
  layout.factor = 1;
  layout.offset = 0;
  EXPECT_DOUBLE_EQ(scaled(layout, -1), 0.5 * 18446744073709551615.0);
  layout.scale = -0.5;
  EXPECT_DOUBLE_EQ(quantum(layout), 0.5);
}

}  // namespace
}  // namespace scree::encoder
