#include "scree/capture/lcm_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <random>
#include <string>
#include <vector>

#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::int64_t kBeginUs = 1'598'612'523'000'001;

/// By LCM's own writer: messages of 100, 101, ... bytes.
void write_log(const std::filesystem::path& file, int count) {
  lcm_eventlog_t* const log = lcm_eventlog_create(file.c_str(), "w");
  ASSERT_NE(log, nullptr);
  for (int i = 0; i < count; ++i) {
    std::string channel = "CHANNEL_" + std::to_string(i);
    std::vector<std::uint8_t> message(static_cast<std::size_t>(100 + i),
                                      static_cast<std::uint8_t>(i));
    lcm_eventlog_event_t event{};
    event.timestamp = kBeginUs + i;
    event.channel = channel.data();
    event.channellen = static_cast<std::int32_t>(channel.size());
    event.data = message.data();
    event.datalen = static_cast<std::int32_t>(message.size());
    ASSERT_EQ(lcm_eventlog_write_event(log, &event), 0);
  }
  lcm_eventlog_destroy(log);
}

struct ReadLog {
  std::vector<LcmEvent> events;
  std::vector<std::vector<std::uint8_t>> messages;
  std::string broken_off;
};

ReadLog read_log(const std::filesystem::path& file) {
  ReadLog read;
  auto reader = LcmLogReader::open(file);
  EXPECT_TRUE(reader) << reader.error().message;
  LcmEvent event;
  while (reader->next(event)) {
    read.messages.emplace_back(event.message.begin(), event.message.end());
    read.events.push_back(event);
  }
  read.broken_off = reader->broken_off();
  return read;
}

TEST(LcmLog, ReadsWhatLcmWrites) {
  const TemporaryFolder folder;
  write_log(folder / "log", 5);
  const ReadLog read = read_log(folder / "log");
  ASSERT_EQ(read.events.size(), 5U);
  EXPECT_EQ(read.events[4].arrival_ns, (kBeginUs + 4) * 1000);
  EXPECT_EQ(read.events[4].channel, "CHANNEL_4");
  EXPECT_EQ(read.messages[4], std::vector<std::uint8_t>(104, 4));
  EXPECT_EQ(read.broken_off, "");
}

TEST(LcmLog, IsKnownByItsFirstBytes) {
  const TemporaryFolder folder;
  write_log(folder / "log.pcap", 1);
  EXPECT_TRUE(is_lcm_log(folder / "log.pcap"));
  EXPECT_FALSE(is_lcm_log(folder.write("short", "\xED\xA1")));
  EXPECT_FALSE(is_lcm_log(folder.write("foreign", "%PDF-1.7")));
  EXPECT_FALSE(is_lcm_log(folder / "none"));
  EXPECT_FALSE(is_lcm_log(folder / ""));
  EXPECT_THAT(LcmLogReader::open(folder / "foreign").error().message, HasSubstr("is no LCM log"));
}

TEST(LcmLog, ALogCutInTheMiddleGivesEverythingBefore) {
  const TemporaryFolder folder;
  write_log(folder / "whole", 5);
  const std::string whole = bytes_of(folder / "whole");
  const ReadLog read = read_log(folder.write("cut", whole.substr(0, whole.size() - 10)));
  EXPECT_EQ(read.events.size(), 4U);
  // The last event has a header of 28 bytes, a channel of 9 and 104 bytes.
  EXPECT_THAT(read.broken_off, AllOf(HasSubstr("cut: "), HasSubstr("131 bytes belong to no")));
}

TEST(LcmLog, WhatIsGarbledIsPassedOver) {
  const TemporaryFolder folder;
  write_log(folder / "whole", 5);
  std::string bytes = bytes_of(folder / "whole");
  constexpr std::size_t kFirstEvent = 28 + 9 + 100, kDataLength = 24;
  bytes[kFirstEvent + kDataLength] = '\x7F';
  const ReadLog read = read_log(folder.write("garbled", bytes));
  ASSERT_EQ(read.events.size(), 4U);
  EXPECT_EQ(read.events[1].channel, "CHANNEL_2");
  EXPECT_THAT(read.broken_off, HasSubstr("138 bytes"));
}

TEST(LcmLog, SurvivesAnyBytes) {
  const TemporaryFolder folder;
  write_log(folder / "whole", 4);
  const std::string whole = bytes_of(folder / "whole");
  std::mt19937 random(5);
  for (int round = 0; round < 500; ++round) {
    std::string bytes = whole.substr(0, random() % 3 == 0 ? random() % whole.size() : whole.size());
    for (int flips = 0; flips < 5 && bytes.size() > 4; ++flips) {
      const std::size_t where = random() % 2 == 0 ? random() % bytes.size() : random() % 60;
      bytes[4 + where % (bytes.size() - 4)] = static_cast<char>(random());
    }
    const auto file = folder.write("garbled", bytes);
    if (is_lcm_log(file)) {
      ASSERT_LE(read_log(file).events.size(), 4U);
    }
  }
}

}  // namespace
}  // namespace scree
