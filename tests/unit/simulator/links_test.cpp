#include "simulator/links.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>

#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct Record {
  std::int64_t t_ns;
  std::vector<std::uint8_t> bytes;
};

/// Records of a pcap file with nanosecond times, read by the format's description.
std::vector<Record> records(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> all{std::istreambuf_iterator<char>(stream), {}};
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, all.data() + at, sizeof value);
    return value;
  };
  EXPECT_EQ(word(0), 0xA1B23C4DU);
  EXPECT_EQ(word(20), 147U);
  std::vector<Record> records;
  for (std::size_t at = 24; at + 16 <= all.size(); at += 16 + word(at + 8)) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(at) + 16;
    records.push_back({word(at) * 1'000'000'000LL + word(at + 4), {begin, begin + word(at + 8)}});
  }
  return records;
}

class Serial : public testing::TestWithParam<std::int64_t> {};

TEST_P(Serial, KeepsAllBytesInOrderWhateverTheReads) {
  const TemporaryFolder folder;
  const fs::path file = folder / "imu.pcap";
  auto pcap = PcapWriter::create_serial(file);
  ASSERT_TRUE(pcap);
  SerialPort port(*pcap, 921600, GetParam(), 1);
  std::vector<std::uint8_t> sent;
  constexpr int kMessages = 300;
  constexpr std::size_t kSize = 73;
  for (int i = 0; i < kMessages; ++i) {
    std::vector<std::uint8_t> message(kSize, static_cast<std::uint8_t>(i));
    sent.insert(sent.end(), message.begin(), message.end());
    port.send(1'000'000'000LL + i * 2'500'000LL, message);
  }
  port.finish();
  ASSERT_TRUE(pcap->close());
  std::vector<std::uint8_t> received;
  std::int64_t before = 0;
  int split = 0;
  int joined = 0;
  for (const Record& record : records(file)) {
    EXPECT_GT(record.t_ns, before);
    before = record.t_ns;
    // No byte before it was sent.
    const auto last =
        static_cast<std::int64_t>((received.size() + record.bytes.size() - 1) / kSize);
    EXPECT_GT(record.t_ns, 1'000'000'000LL + last * 2'500'000LL);
    split += record.bytes.size() < kSize ? 1 : 0;
    joined += record.bytes.size() > kSize ? 1 : 0;
    received.insert(received.end(), record.bytes.begin(), record.bytes.end());
  }
  EXPECT_EQ(received, sent);
  if (GetParam() == 0) {
    EXPECT_GT(split, 20);
  } else {
    EXPECT_GT(joined, 20);
  }
}

INSTANTIATE_TEST_SUITE_P(Reads, Serial, testing::Values(0, 16'000'000),
                         [](const auto& which) { return which.param == 0 ? "Soon" : "InBursts"; });

TEST(SerialPort, CorruptsTheShareThatItIsAskedFor) {
  const TemporaryFolder folder;
  const fs::path file = folder / "imu.pcap";
  auto pcap = PcapWriter::create_serial(file);
  ASSERT_TRUE(pcap);
  SerialPort port(*pcap, 921600, 0, 1);
  constexpr double kShare = 0.001;  // few enough to be told apart
  port.corrupt(kShare);
  // Bytes that tell their place modulo 251: a flipped bit is one that does not fit in, a lost one
  // lets the count skip, one too many delays it.
  constexpr int kBytes = 600'000, kMessage = 100, kModulus = 251;
  for (int i = 0; i < kBytes; i += kMessage) {
    std::vector<std::uint8_t> message;
    for (int k = i; k < i + kMessage; ++k)
      message.push_back(static_cast<std::uint8_t>(k % kModulus));
    port.send(1'000'000'000LL + i * 20'000LL, message);
  }
  port.finish();
  ASSERT_TRUE(pcap->close());
  std::vector<int> received;
  for (const Record& record : records(file)) {
    received.insert(received.end(), record.bytes.begin(), record.bytes.end());
  }
  int flipped = 0, lost = 0, inserted = 0, next = 0;
  for (std::size_t i = 0; i + 2 < received.size(); ++i) {
    const auto follows = [&](int byte, int places) { return byte == (next + places) % kModulus; };
    if (!follows(received[i], 0)) {
      if (follows(received[i], 1) && follows(received[i + 1], 2)) {
        ++lost;
        ++next;
      } else if (follows(received[i + 1], 0)) {
        ++inserted;
        --next;
      } else {
        ++flipped;
      }
    }
    ++next;
  }
  for (const int count : {flipped, lost, inserted}) EXPECT_NEAR(count, kBytes * kShare / 3, 50);
}

TEST(CanBus, LosesTheEncodersFramesButNotThoseOfOthers) {
  const TemporaryFolder folder;
  const fs::path file = folder / "can.log";
  EncoderSettings layout;
  layout.can_id = 0x123;
  const Motion motion{Pose()};
  SimulatedEncoder encoder(motion, layout, {}, 1);
  constexpr std::int64_t kBegin = 1'598'601'600'000'000'000;
  auto log = CanLogWriter::create(file);
  ASSERT_TRUE(log);
  CanBus bus(*log, layout, 1);
  bus.lose_encoder([](std::int64_t t_ns) { return t_ns >= kBegin + 2'000'000'000; });
  bus.start(kBegin, 100);
  bus.run_until(kBegin + 5'000'000'000, encoder);
  ASSERT_TRUE(log->close());
  std::ifstream stream(file);
  int encoders = 0, others_late = 0;
  for (std::string line; std::getline(stream, line);) {
    const bool is_encoder = line.find(" 123#") != std::string::npos;
    encoders += is_encoder ? 1 : 0;
    others_late += !is_encoder && std::stod(line.substr(1)) > 1'598'601'603 ? 1 : 0;
  }
  EXPECT_EQ(encoders, 200);
  EXPECT_GT(others_late, 5);
}

TEST(CanBus, LogsAsCandumpDoes) {
  const TemporaryFolder folder;
  const fs::path file = folder / "can.log";
  EncoderSettings layout;
  layout.can_id = 0x18FF50E5;
  const Motion motion{Pose()};
  SimulatedEncoder encoder(motion, layout, {}, 1);
  auto log = CanLogWriter::create(file);
  ASSERT_TRUE(log);
  CanBus bus(*log, layout, 1);
  bus.start(1'598'601'600'000'000'000, 100);
  bus.run_until(1'598'601'601'000'000'000, encoder);
  ASSERT_TRUE(log->close());
  std::ifstream stream(file);
  const auto has_the_form = testing::MatchesRegex(
      R"(\([0-9]{10}\.[0-9]{6}\) can0 ([0-9A-F]{3}|[0-9A-F]{8})#[0-9A-F]{16})");
  int encoders = 0;
  int all = 0;
  double before = 0;
  for (std::string line; std::getline(stream, line); ++all) {
    EXPECT_THAT(line, has_the_form);
    encoders += line.find(" 18FF50E5#") != std::string::npos ? 1 : 0;
    const double t = std::stod(line.substr(1));
    EXPECT_GT(t, before);
    before = t;
  }
  EXPECT_EQ(encoders, 101);
  EXPECT_GT(all, encoders);
}

}  // namespace
}  // namespace scree
