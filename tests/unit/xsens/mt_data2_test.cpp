#include "scree/drivers/xsens/mt_data2.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>

#include "scree/drivers/xsens/orientation.hpp"
#include "unit/allocation_counter.hpp"
#include "unit/xsens/message_builder.hpp"

namespace scree::xsens {
namespace {

using test::ByteVector;
using test::integer;
using test::item;
using test::joined;
using test::put_real;
using test::put_unsigned;

std::uint64_t refused(const ItemCounts& counts, Refusal reason) {
  return counts.refused[static_cast<std::size_t>(reason)];
}

struct Sent {
  std::vector<double> value;
  int format, frame;
};

template <std::size_t N>
Sent sent(const std::optional<Numbers<N>>& numbers) {
  if (!numbers) return {{}, -1, -1};
  return {{numbers->value.begin(), numbers->value.end()},
          static_cast<int>(numbers->format),
          static_cast<int>(numbers->frame)};
}

/// An item of real numbers: its id, values that every format holds exactly, and where they go.
struct RealItem {
  unsigned id;
  std::vector<double> value;
  std::function<Sent(const Measurement&)> field;
  bool has_frame = false;
};

const std::vector<RealItem>& real_items() {
  using M = Measurement;
  const std::vector<double> xyz = {1.5, -2.25, 1023.0 + 1.0 / 8192};
  const std::vector<double> turn = {0.5, -0.5, 0.5, 0.5};
  static const std::vector<RealItem> items = {
      {0x0810, {-40.125}, [](const M& m) { return sent(m.temperature); }},
      {0x2010, turn, [](const M& m) { return sent(m.quaternion); }, true},
      {0x2020,
       {0, 1, 0, -1, 0, 0, 0, 0, 1},
       [](const M& m) { return sent(m.rotation_matrix); },
       true},
      {0x2030, {-179.5, 89.75, 0.25}, [](const M& m) { return sent(m.euler_angles); }, true},
      {0x4010, xyz, [](const M& m) { return sent(m.delta_v); }},
      {0x4020, xyz, [](const M& m) { return sent(m.acceleration); }},
      {0x4030, xyz, [](const M& m) { return sent(m.free_acceleration); }, true},
      {0x4040, xyz, [](const M& m) { return sent(m.acceleration_hr); }},
      {0x5010, {-12.5}, [](const M& m) { return sent(m.altitude_msl); }},
      {0x5020, {812.75}, [](const M& m) { return sent(m.altitude_ellipsoid); }},
      {0x5030, xyz, [](const M& m) { return sent(m.position_ecef); }},
      {0x5040, {57.5, -11.875}, [](const M& m) { return sent(m.latitude_longitude); }},
      {0x8020, xyz, [](const M& m) { return sent(m.rate_of_turn); }},
      {0x8030, turn, [](const M& m) { return sent(m.delta_q); }},
      {0x8040, xyz, [](const M& m) { return sent(m.rate_of_turn_hr); }},
      {0xC020, xyz, [](const M& m) { return sent(m.magnetic_field); }},
      {0xC030, xyz, [](const M& m) { return sent(m.magnetic_field_corrected); }},
      {0xD010, xyz, [](const M& m) { return sent(m.velocity); }, true},
  };
  return items;
}

ByteVector bytes_of(const RealItem& real, unsigned id) {
  ByteVector data;
  for (const double value : real.value) put_real(data, value, static_cast<int>(id & 3U));
  return item(id, data);
}

TEST(MtData2, RealNumbersInEveryFormatAndFrame) {
  for (const RealItem& real : real_items()) {
    for (const unsigned frame : {0x0U, 0x4U, 0x8U}) {
      if (frame != 0 && !real.has_frame) continue;
      for (unsigned format = 0; format < 4; ++format) {
        const unsigned id = real.id | frame | format;
        SCOPED_TRACE(id);
        ItemCounts counts;
        const Sent read = real.field(decode_mt_data2(bytes_of(real, id), counts));
        EXPECT_EQ(read.value, real.value);
        EXPECT_EQ(read.format, static_cast<int>(format));
        EXPECT_EQ(read.frame, static_cast<int>(frame));
        EXPECT_EQ(counts.decoded, 1U);
        EXPECT_EQ(counts.refused, RefusalCounts{});
      }
    }
  }
}

TEST(MtData2, FixedPointNumbersOfTheirWholeRange) {
  const auto read = [](unsigned format, const ByteVector& data) {
    ItemCounts counts;
    return decode_mt_data2(item(0x0810U | format, data), counts).temperature->value[0];
  };
  EXPECT_EQ(read(1, {0x7F, 0xFF, 0xFF, 0xFF}), 2048 - 1.0 / 1048576);
  EXPECT_EQ(read(1, {0x80, 0x00, 0x00, 0x00}), -2048);
  EXPECT_EQ(read(1, {0xFF, 0xFF, 0xFF, 0xFF}), -1.0 / 1048576);
  // Fraction first, as the manual orders them.
  EXPECT_EQ(read(2, {0x80, 0x00, 0x00, 0x00, 0x00, 0x01}), 1.5);
  EXPECT_EQ(read(2, {0x80, 0x00, 0x00, 0x00, 0xFF, 0xFE}), -1.5);
  EXPECT_EQ(read(2, {0xFF, 0xFF, 0xFF, 0xFF, 0x7F, 0xFF}), 32768 - 1.0 / 4294967296);
  EXPECT_EQ(read(2, {0x00, 0x00, 0x00, 0x00, 0x80, 0x00}), -32768);
}

TEST(MtData2, WholeNumbers) {
  ItemCounts counts;
  const Measurement read = decode_mt_data2(
      joined({integer(0x1020, 0xABCD, 2), integer(0x1030, 345'600'000, 4), integer(0x1040, 7, 1),
              integer(0x1050, 250, 1), integer(0x1060, 0xFEDCBA98, 4), integer(0x1070, 86399, 4),
              integer(0x1080, 0x00010203, 4), integer(0x1090, 255, 1),
              integer(0x10A0, 0x0102030405060708, 8), integer(0x3010, 101325, 4),
              integer(0x7030, 77, 4), integer(0xB010, 1000, 2), integer(0xB020, 65535, 2),
              integer(0xE010, 0x85, 1), integer(0xE020, 0x81800007, 4), integer(0xE040, 0xC4, 1),
              integer(0xE080, 0x03600123, 4), integer(0xE090, 4711, 2)}),
      counts);
  EXPECT_EQ(read.packet_counter, 0xABCD);
  EXPECT_EQ(read.itow, 345'600'000U);
  EXPECT_EQ(read.gnss_age, 7);
  EXPECT_EQ(read.pressure_age, 250);
  EXPECT_EQ(read.sample_time_fine, 0xFEDCBA98U);
  EXPECT_EQ(read.sample_time_coarse, 86399U);
  ASSERT_TRUE(read.frame_range);
  EXPECT_EQ(read.frame_range->first, 1);
  EXPECT_EQ(read.frame_range->last, 0x0203);
  EXPECT_EQ(read.packet_counter8, 255);
  EXPECT_EQ(read.sample_time64, 0x0102030405060708U);
  EXPECT_EQ(read.baro_pressure, 101325U);
  EXPECT_EQ(read.gnss_pvt_pulse, 77U);
  EXPECT_EQ(read.analog_in[0], 1000);
  EXPECT_EQ(read.analog_in[1], 65535);
  EXPECT_EQ(read.status_byte, 0x85);
  EXPECT_EQ(read.status_word, 0x81800007U);
  EXPECT_EQ(read.rssi, -60);
  EXPECT_EQ(read.device_id, 0x03600123U);
  EXPECT_EQ(read.location_id, 4711);
  EXPECT_EQ(counts.decoded, 18U);
  ItemCounts more;
  EXPECT_EQ(decode_mt_data2(integer(0xE080, 0x0080001234567890, 8), more).device_id,
            0x0080001234567890U);
}

TEST(MtData2, TimesTriggersAndRawCounts) {
  ByteVector utc, trigger, raw;
  for (const auto& [value, size] : {std::pair{999'900'000U, 4},
                                    {2026U, 2},
                                    {12U, 1},
                                    {31U, 1},
                                    {23U, 1},
                                    {59U, 1},
                                    {60U, 1},
                                    {7U, 1}}) {
    put_unsigned(utc, value, size);
  }
  for (const auto& [value, size] : {std::pair{2U, 1}, {1U, 1}, {0xCAFEF00DU, 4}, {513U, 2}}) {
    put_unsigned(trigger, value, size);
  }
  for (int i = 0; i < 10; ++i) put_unsigned(raw, static_cast<std::uint64_t>(-100 * i), 2);
  ItemCounts counts;
  const Measurement read =
      decode_mt_data2(joined({item(0x1010, utc), item(0x4810, trigger), item(0x4820, trigger),
                              item(0x4830, trigger), item(0xA010, raw),
                              item(0xA020, {0xFF, 0xFF, 0x00, 0x02, 0x80, 0x00})}),
                      counts);
  ASSERT_TRUE(read.utc_time);
  EXPECT_EQ(read.utc_time->nanosecond, 999'900'000U);
  EXPECT_EQ(read.utc_time->year, 2026);
  EXPECT_EQ(read.utc_time->month, 12);
  EXPECT_EQ(read.utc_time->day, 31);
  EXPECT_EQ(read.utc_time->hour, 23);
  EXPECT_EQ(read.utc_time->minute, 59);
  EXPECT_EQ(read.utc_time->second, 60);
  EXPECT_EQ(read.utc_time->valid, 7);
  for (const auto& indication : read.trigger_in) {
    ASSERT_TRUE(indication);
    EXPECT_EQ(indication->line, 2);
    EXPECT_EQ(indication->polarity, 1);
    EXPECT_EQ(indication->timestamp, 0xCAFEF00DU);
    EXPECT_EQ(indication->frame, 513);
  }
  ASSERT_TRUE(read.raw_sample);
  EXPECT_EQ(read.raw_sample->acceleration[2], 65336);
  EXPECT_EQ(read.raw_sample->rate_of_turn[0], 65236);
  EXPECT_EQ(read.raw_sample->magnetic_field[1], 64836);
  EXPECT_EQ(read.raw_sample->temperature, -900);
  EXPECT_EQ(read.raw_gyro_temperatures, (std::array<std::int16_t, 3>{-1, 2, -32768}));
  EXPECT_EQ(counts.decoded, 6U);
}

TEST(MtData2, SatellitesAsManyAsTheMessageHas) {
  ByteVector data;
  put_unsigned(data, 123456, 4);
  put_unsigned(data, 60, 1);
  put_unsigned(data, 0, 3);
  for (unsigned i = 0; i < 60; ++i) put_unsigned(data, i << 24U | 0x00112233U, 4);
  ItemCounts counts;
  const Measurement read = decode_mt_data2(item(0x7020, data), counts);
  ASSERT_TRUE(read.gnss_sat_info);
  EXPECT_EQ(read.gnss_sat_info->itow, 123456U);
  EXPECT_EQ(read.gnss_sat_info->count, 60);
  EXPECT_EQ(read.gnss_sat_info->satellites[59].gnss, 59);
  EXPECT_EQ(read.gnss_sat_info->satellites[59].satellite, 0x11);
  EXPECT_EQ(read.gnss_sat_info->satellites[59].carrier_to_noise, 0x22);
  EXPECT_EQ(read.gnss_sat_info->satellites[59].flags, 0x33);
  // More than there is room for, and more than was sent.
  data[4] = 61;
  data.insert(data.end(), 4, 0);
  EXPECT_FALSE(decode_mt_data2(item(0x7020, data), counts).gnss_sat_info);
  data.resize(8 + 4 * 5);
  data[4] = 6;
  EXPECT_FALSE(decode_mt_data2(item(0x7020, data), counts).gnss_sat_info);
  EXPECT_EQ(refused(counts, Refusal::size), 2U);
}

TEST(MtData2, AWrongSizeIsRefusedAndTheRestIsRead) {
  const std::vector<std::pair<unsigned, std::size_t>> fixed = {
      {0x1010, 12}, {0x1020, 2}, {0x1030, 4},  {0x1040, 1}, {0x1050, 1}, {0x1060, 4}, {0x1070, 4},
      {0x1080, 4},  {0x1090, 1}, {0x10A0, 8},  {0x3010, 4}, {0x4810, 8}, {0x4820, 8}, {0x4830, 8},
      {0x7010, 94}, {0x7030, 4}, {0xA010, 20}, {0xA020, 6}, {0xB010, 2}, {0xB020, 2}, {0xE010, 1},
      {0xE020, 4},  {0xE040, 1}, {0xE080, 4},  {0xE090, 2}};
  std::vector<std::pair<unsigned, std::size_t>> all = fixed;
  constexpr std::size_t kSizes[] = {4, 4, 6, 8};
  for (const RealItem& real : real_items()) {
    for (unsigned format = 0; format < 4; ++format) {
      all.emplace_back(real.id | format, real.value.size() * kSizes[format]);
    }
  }
  for (const auto& [id, size] : all) {
    SCOPED_TRACE(id);
    for (const std::size_t wrong : {size - 1, size + 1, std::size_t{0}, std::size_t{255}}) {
      ItemCounts counts;
      const Measurement read =
          decode_mt_data2(joined({item(id, ByteVector(wrong)), integer(0xE090, 5, 2)}), counts);
      EXPECT_EQ(refused(counts, Refusal::size), 1U) << wrong;
      EXPECT_EQ(counts.decoded, 1U);
      EXPECT_EQ(read.location_id, 5);
    }
  }
}

TEST(MtData2, UnknownKindsAreCountedAndPassedOver) {
  ItemCounts counts;
  const Measurement read =
      decode_mt_data2(joined({integer(0xF123, 1, 8), item(0x0000, {}),
                              item(0x2040, ByteVector(255)), integer(0x1020, 9, 2)}),
                      counts);
  EXPECT_EQ(counts.unknown, 3U);
  EXPECT_EQ(read.packet_counter, 9);
}

TEST(MtData2, AnItemThatGoesOnBehindTheMessageEndsIt) {
  const ByteVector whole = joined({integer(0x1020, 9, 2), integer(0x1060, 5, 4)});
  for (std::size_t cut = 6; cut < whole.size(); ++cut) {
    ItemCounts counts;
    const Measurement read = decode_mt_data2(Bytes(whole).first(cut), counts);
    EXPECT_EQ(refused(counts, Refusal::truncated), 1U) << cut;
    EXPECT_EQ(read.packet_counter, 9);
    EXPECT_FALSE(read.sample_time_fine);
  }
}

TEST(MtData2, NumbersThatAreNoneAreRefused) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    for (const RealItem& real : real_items()) {
      for (const unsigned format : {0U, 3U}) {
        for (std::size_t i = 0; i < real.value.size(); ++i) {
          RealItem one = real;
          one.value[i] = bad;
          ItemCounts counts;
          const Measurement read = decode_mt_data2(bytes_of(one, real.id | format), counts);
          EXPECT_EQ(refused(counts, Refusal::not_finite), 1U) << real.id;
          EXPECT_TRUE(real.field(read).value.empty());
        }
      }
    }
  }
}

TEST(MtData2, RotationsThatAreNoneAreRefused) {
  ItemCounts counts;
  for (const double scale : {0.0, 0.5, 0.98, 1.02, 3.0, 1e300}) {
    EXPECT_FALSE(
        decode_mt_data2(test::reals(0x2013, {0.6 * scale, 0, 0.8 * scale, 0}), counts).quaternion);
    EXPECT_FALSE(
        decode_mt_data2(test::reals(0x8033, {0.6 * scale, 0, 0.8 * scale, 0}), counts).delta_q);
    EXPECT_FALSE(
        decode_mt_data2(test::reals(0x2023, {scale, 0, 0, 0, scale, 0, 0, 0, scale}), counts)
            .rotation_matrix);
  }
  // A mirror is no rotation either.
  EXPECT_FALSE(
      decode_mt_data2(test::reals(0x2020, {1, 0, 0, 0, 1, 0, 0, 0, -1}), counts).rotation_matrix);
  EXPECT_EQ(refused(counts, Refusal::not_unit), 19U);
  for (const double scale : {0.999, 1.001}) {
    EXPECT_TRUE(
        decode_mt_data2(test::reals(0x2010, {0.6 * scale, 0, 0.8 * scale, 0}), counts).quaternion);
  }
}

TEST(MtData2, AnyBytesAreSafe) {
  std::mt19937 random(11);
  ByteVector valid;
  for (const RealItem& real : real_items()) {
    const ByteVector bytes = bytes_of(real, real.id | 3U);
    valid.insert(valid.end(), bytes.begin(), bytes.end());
  }
  ItemCounts counts;
  for (int round = 0; round < 20000; ++round) {
    ByteVector bytes = valid;
    const std::size_t changes = 1 + random() % 20;
    for (std::size_t i = 0; i < changes; ++i) {
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    }
    if (round % 3 == 0) {
      bytes.resize(random() % bytes.size());
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    }
    const std::size_t before = test::allocations();
    const Measurement read = decode_mt_data2(bytes, counts);
    const auto orientation = orientation_enu(read);
    EXPECT_EQ(test::allocations(), before);
    if (orientation) {
      ASSERT_NEAR(orientation->norm(), 1, 1e-9);
    }
  }
  EXPECT_GT(counts.unknown, 0U);
  for (const Refusal reason : {Refusal::truncated, Refusal::size, Refusal::not_unit}) {
    EXPECT_GT(refused(counts, reason), 0U);
  }
}

}  // namespace
}  // namespace scree::xsens
