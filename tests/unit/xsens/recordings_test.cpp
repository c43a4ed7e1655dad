// Recordings of an MTi-G-710, kept outside the project, and what another decoder read in them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "scree/capture/pcap_reader.hpp"
#include "scree/drivers/xsens/imu_stream.hpp"
#include "unit/recordings.hpp"
#include "unit/temporary_folder.hpp"

namespace scree::xsens {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Name and text of each value, as the reference lists them.
using Listing = std::vector<std::pair<std::string, std::string>>;

Listing parse_listing(const std::string& block) {
  Listing listing;
  std::istringstream lines(block);
  std::string name;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  ")) {
      const std::size_t colon = name == "UTCTime" ? std::string::npos : line.find(':');
      const bool has_field = colon != std::string::npos;
      std::string full = name;
      if (has_field) full.append(1, '.').append(line, 2, colon - 2);
      listing.emplace_back(full, line.substr(has_field ? colon + 1 : 2));
    } else {
      name = line.substr(0, line.size() - 1);
    }
  }
  return listing;
}

/// Lists a measurement in the reference's words.
class Lister {
public:
  Listing listing;

  void add(const std::string& name, std::int64_t value) {
    listing.emplace_back(name, std::to_string(value));
  }
  void add(const std::string& name, double value) {
    char digits[64];
    listing.emplace_back(name, std::string(digits, std::to_chars(digits, digits + 64, value).ptr));
  }
  template <std::size_t N>
  void add(const std::string& name, const std::optional<Numbers<N>>& numbers,
           const std::vector<std::string>& fields, bool has_frame = false) {
    if (!numbers) return;
    static constexpr std::array kFormats = {"Float32", "FP1220", "FP1632", "Float64"};
    const std::string title = name + (has_frame ? "(EastNorthUp," : "(") +
                              kFormats.at(static_cast<std::size_t>(numbers->format)) + ")";
    EXPECT_EQ(numbers->frame, LocalFrame::enu);
    for (std::size_t i = 0; i < N; ++i) {
      add(fields.empty() ? title : title + "." + fields[i], (*numbers)[i]);
    }
  }
  void add(const UtcTime& utc) {
    char text[64];
    std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%02d.%09u", utc.year, utc.month,
                  utc.day, utc.hour, utc.minute, utc.second, utc.nanosecond);
    std::string trimmed(text);
    trimmed.erase(trimmed.find_last_not_of("0.") + 1);
    if (trimmed.size() < 19) trimmed = std::string(text, 19);
    listing.emplace_back("UTCTime", trimmed + "Z");
  }
  void add(const GnssPvtData& pvt) {
    const auto field = [&](const char* name, std::int64_t value) {
      add(std::string("GNSSPVTData.") + name, value);
    };
    field("ITOW", pvt.itow);
    field("Year", pvt.year);
    field("Month", pvt.month);
    field("Day", pvt.day);
    field("Hour", pvt.hour);
    field("Min", pvt.minute);
    field("Sec", pvt.second);
    field("Valid", pvt.valid);
    field("TAcc", pvt.time_accuracy);
    field("Nano", pvt.nanosecond);
    field("FixType", pvt.fix_type);
    field("Flags", pvt.flags);
    field("NumSV", pvt.satellites);
    field("Reserved1", pvt.reserved);
    field("Lon", pvt.longitude);
    field("Lat", pvt.latitude);
    field("Height", pvt.height);
    field("HMSL", pvt.height_msl);
    field("HAcc", pvt.horizontal_accuracy);
    field("VAcc", pvt.vertical_accuracy);
    field("VelN", pvt.velocity_north);
    field("VelE", pvt.velocity_east);
    field("VelD", pvt.velocity_down);
    field("GSpeed", pvt.ground_speed);
    field("HeadMot", pvt.heading_of_motion);
    field("SAcc", pvt.speed_accuracy);
    field("HeadAcc", pvt.heading_accuracy);
    field("HeadVeh", pvt.heading_of_vehicle);
    field("GDOP", pvt.gdop);
    field("PDOP", pvt.pdop);
    field("TDOP", pvt.tdop);
    field("VDOP", pvt.vdop);
    field("HDOP", pvt.hdop);
    field("NDOP", pvt.ndop);
    field("EDOP", pvt.edop);
  }
};

Listing list(const Measurement& measurement) {
  Lister lister;
  if (measurement.packet_counter)
    lister.add("PacketCounter", std::int64_t{*measurement.packet_counter});
  if (measurement.sample_time_fine) {
    lister.add("SampleTimeFine", std::int64_t{*measurement.sample_time_fine});
  }
  if (measurement.utc_time) lister.add(*measurement.utc_time);
  if (measurement.gnss_pvt_data) lister.add(*measurement.gnss_pvt_data);
  if (measurement.status_byte) {
    lister.listing.emplace_back("StatusByte", std::bitset<8>(*measurement.status_byte).to_string());
  }
  if (measurement.status_word) {
    lister.listing.emplace_back("StatusWord",
                                std::bitset<32>(*measurement.status_word).to_string());
  }
  const std::vector<std::string> xyz = {"X", "Y", "Z"};
  lister.add("EulerAngles", measurement.euler_angles, xyz, true);
  lister.add("Acceleration", measurement.acceleration, xyz);
  lister.add("DeltaV", measurement.delta_v, xyz);
  lister.add("RateOfTurn", measurement.rate_of_turn, xyz);
  lister.add("DeltaQ", measurement.delta_q, {"Q0", "Q1", "Q2", "Q3"});
  lister.add("LatLon", measurement.latitude_longitude, {"Lat", "Lon"});
  lister.add("AltitudeEllipsoid", measurement.altitude_ellipsoid, {});
  lister.add("VelocityXYZ", measurement.velocity, xyz, true);
  return lister.listing;
}

/// By name; numbers by their value, since two programs write them differently.
void expect_same(Listing ours, Listing theirs) {
  std::sort(ours.begin(), ours.end());
  std::sort(theirs.begin(), theirs.end());
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    ASSERT_EQ(ours[i].first, theirs[i].first);
    if (ours[i].second == theirs[i].second) continue;
    double a = 0, b = 0;
    std::from_chars(ours[i].second.data(), ours[i].second.data() + ours[i].second.size(), a);
    std::from_chars(theirs[i].second.data(), theirs[i].second.data() + theirs[i].second.size(), b);
    EXPECT_EQ(a, b) << ours[i].first << ": " << ours[i].second << " and " << theirs[i].second;
    EXPECT_TRUE(ours[i].first.find("UTC") == std::string::npos) << ours[i].second;
  }
}

std::vector<std::string> blocks_of(const std::string& text) {
  std::vector<std::string> blocks;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = text.find("\n\n", begin);
    if (end == std::string::npos) end = text.size();
    if (const std::string block = text.substr(begin, end - begin); block.size() > 1) {
      blocks.push_back(block);
    }
    begin = end + 2;
  }
  return blocks;
}

class Recordings : public ::testing::TestWithParam<const char*> {
protected:
  std::string file(const char* name) const { return std::string("xsens/") + GetParam() + name; }
  std::vector<std::uint8_t> bytes() const {
    const std::string text = text_of(shared(file("/output.bin")));
    return {text.begin(), text.end()};
  }
};

TEST_P(Recordings, EveryValueOfEveryMessageIsTheReferences) {
  NEEDS(file(""));
  const std::vector<std::string> expected = blocks_of(text_of(shared(file("/output.golden"))));
  ASSERT_EQ(expected.size(), 100U);
  std::size_t messages = 0;
  ItemCounts counts;
  Framer framer;
  framer.take(bytes(), [&](const Message& message) {
    ASSERT_EQ(message.id, MessageId::mt_data2);
    ASSERT_LT(messages, expected.size());
    SCOPED_TRACE(messages);
    expect_same(list(decode_mt_data2(message.data, counts)), parse_listing(expected[messages]));
    ++messages;
  });
  EXPECT_EQ(messages, 100U);
  EXPECT_EQ(counts.unknown, 0U);
  EXPECT_EQ(counts.refused, RefusalCounts{});
}

TEST_P(Recordings, MessagesAreTheReferences) {
  NEEDS(file(""));
  std::istringstream lines(text_of(shared(file("/messages.golden"))));
  const std::vector<std::uint8_t> stream = bytes();
  std::size_t begin = 0;
  Framer framer;
  framer.take(stream, [&](const Message& message) {
    std::string expected;
    std::getline(lines, expected);
    std::string hex;
    for (std::size_t i = begin; i < begin + message.size; ++i) {
      char digits[3];
      std::snprintf(digits, sizeof digits, "%02x", stream[i]);
      hex += digits;
    }
    EXPECT_EQ(hex, expected);
    begin += message.size;
  });
  EXPECT_EQ(begin, stream.size());
  std::string more;
  EXPECT_FALSE(std::getline(lines, more) && !more.empty());
}

TEST_P(Recordings, GnssMessagesFromThePastDisturbNothing) {
  NEEDS(file(""));
  const std::vector<std::uint8_t> stream_bytes = bytes();
  std::vector<std::int64_t> samples, gnss;
  constexpr std::int64_t kStart = 1'600'000'000'000'000'000;
  ImuStream stream(
      ImuSettings{}, [&](const ImuSample& sample) { samples.push_back(sample.t_ns); },
      [&](std::int64_t t_ns, const Measurement& measurement) {
        if (measurement.gnss_pvt_data) gnss.push_back(t_ns - samples.back());
      });
  Framer splitter;
  std::int64_t last_ns = kStart, first_tick = -1;
  std::size_t begin = 0;
  splitter.take(stream_bytes, [&](const Message& message) {
    ItemCounts ignored;
    const Measurement measurement = decode_mt_data2(message.data, ignored);
    if (measurement.is_inertial()) {
      if (first_tick < 0) first_tick = *measurement.sample_time_fine;
      last_ns = kStart + (*measurement.sample_time_fine - first_tick) * kTickNs;
    }
    // A millisecond after the sample it is sent, at 921600 baud.
    const auto line_ns = static_cast<std::int64_t>(message.size) * 10'851;
    stream.take(Bytes(stream_bytes).subspan(begin, message.size), last_ns + 1'000'000 + line_ns);
    begin += message.size;
  });
  EXPECT_EQ(stream.counters().accepted, 100U);
  EXPECT_EQ(stream.counters().samples, 96U);
  EXPECT_EQ(stream.counters().all_refused(), 0U);
  EXPECT_EQ(stream.counters().lost, 0U);
  EXPECT_EQ(stream.counters().device_restarts + stream.counters().host_steps, 0U);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(samples[i] - samples[i - 1]), 10e6, 1e4) << i;
  }
  ASSERT_EQ(gnss.size(), 4U);
  for (const std::int64_t before : gnss) {
    EXPECT_LT(before, -40'000'000);
    EXPECT_GT(before, -53'000'000);
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, Recordings, ::testing::Values("1", "2", "3"));

TEST(Interop, CaptureDecodesWithoutRefusals) {
  NEEDS("captures/interop/imu.pcap");
  auto reader = PcapReader::open(shared("captures/interop/imu.pcap"));
  ASSERT_TRUE(reader) << reader.error().message;
  std::vector<ImuSample> samples;
  ImuStream stream(ImuSettings{}, [&](const ImuSample& sample) { samples.push_back(sample); });
  PcapRecord record;
  while (reader->next(record)) stream.take(record.bytes, record.arrival_ns);
  stream.flush();
  EXPECT_EQ(stream.counters().all_refused(), 0U);
  EXPECT_EQ(stream.counters().lost, 0U);
  EXPECT_EQ(stream.counters().bytes_skipped, 0U);
  ASSERT_GT(samples.size(), 700U);
  for (std::size_t i = 100; i < samples.size(); ++i) {
    ASSERT_TRUE(samples[i].has_orientation && samples[i].has_rate && samples[i].has_acceleration);
    EXPECT_NEAR(static_cast<double>(samples[i].t_ns - samples[i - 1].t_ns), 10e6, 0.5e6) << i;
    // Specific force points up where the robot does not accelerate much.
    EXPECT_GT((samples[i].orientation * samples[i].acceleration).normalized().z(), 0.8) << i;
  }
}

}  // namespace
}  // namespace scree::xsens
