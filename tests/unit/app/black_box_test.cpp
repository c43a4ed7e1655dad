#include "app/black_box.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "scree/core/nanoseconds.hpp"
#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::IsEmpty;

constexpr std::int64_t kBegin = 1'600'000'000 * kSecond;  // 2020-09-13T12:26:40

class BlackBoxTest : public ::testing::Test {
protected:
  BlackBox open(std::int64_t now_ns = kBegin) {
    auto box = BlackBox::open(settings_, now_ns);
    EXPECT_TRUE(box) << box.error().message;
    return std::move(*box);
  }
  /// A message a second, of seconds [from, to), with its second in it.
  static void feed(BlackBox& box, int from, int to, std::size_t size = 1) {
    for (int second = from; second < to; ++second) {
      std::vector<std::uint8_t> message(size, static_cast<std::uint8_t>(second));
      box.take("CHANNEL", kBegin + second * kSecond, message);
    }
  }
  std::vector<std::string> logs() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      if (entry.path().extension() == ".lcm") names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    return names;
  }
  /// The seconds of a log's messages, by the description of LCM's log format alone.
  std::vector<int> seconds_in(const std::string& log) const {
    std::ifstream file(folder_ / log, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const auto number = [&](std::size_t at, std::size_t size) {
      std::uint64_t value = 0;
      for (std::size_t i = at; i < at + size; ++i)
        value = value << 8 | static_cast<std::uint8_t>(bytes.at(i));
      return value;
    };
    std::vector<int> seconds;
    for (std::size_t at = 0; at < bytes.size();) {
      EXPECT_EQ(number(at, 4), 0xEDA1DA01U);
      const std::size_t channel = number(at + 20, 4), data = number(at + 24, 4);
      EXPECT_EQ(bytes.substr(at + 28, channel), "CHANNEL");
      const auto second = static_cast<std::uint8_t>(bytes.at(at + 28 + channel));
      EXPECT_EQ(number(at + 12, 8),
                static_cast<std::uint64_t>(kBegin / 1000) + 1'000'000U * second);
      seconds.push_back(second);
      at += 28 + channel + data;
    }
    return seconds;
  }
  std::uint64_t ring_bytes() const {
    std::uint64_t bytes = 0;
    for (const auto& part : fs::directory_iterator(folder_ / "ring")) bytes += part.file_size();
    return bytes;
  }

  TemporaryFolder folder_;
  BlackBoxSettings settings_{.folder = folder_.path().string(), .seconds = 12};
};

TEST_F(BlackBoxTest, HoldsTheLatestPastAndLittleMore) {
  BlackBox box = open();
  feed(box, 0, 40);
  box.close("blind", kBegin + 40 * kSecond);
  ASSERT_THAT(logs(), ElementsAre("2020-09-13T12-27-20.000_blind.lcm"));
  const std::vector<int> seconds = seconds_in(logs()[0]);
  EXPECT_EQ(seconds.back(), 39);
  EXPECT_LE(seconds.front(), 40 - 12);
  EXPECT_GE(seconds.front(), 40 - 12 - 3);
  for (std::size_t i = 1; i < seconds.size(); ++i) EXPECT_EQ(seconds[i], seconds[i - 1] + 1);
  EXPECT_EQ(ring_bytes(), 0U);
}

TEST_F(BlackBoxTest, NeverTakesMoreOfTheDiskThanItMay) {
  settings_.megabytes = 6;
  BlackBox box = open();
  feed(box, 0, 100, 900'000);
  EXPECT_LE(ring_bytes(), 6'000'000U + 2'000'000U);
  EXPECT_GE(ring_bytes(), 3'000'000U);
}

TEST_F(BlackBoxTest, WhatACrashLeftIsClosedAtTheNextStart) {
  {
    BlackBox box = open();
    feed(box, 0, 5);
  }
  fs::remove(folder_ / "never");
  {
    BlackBox box = open(kBegin + 9 * kSecond);
    ASSERT_THAT(logs(), ElementsAre("2020-09-13T12-26-49.000_crash.lcm"));
    EXPECT_THAT(seconds_in(logs()[0]), ElementsAre(0, 1, 2, 3, 4));
    feed(box, 5, 6);
    box.close("end", kBegin + 10 * kSecond);
    EXPECT_THAT(seconds_in(logs()[1]), ElementsAre(5));
  }
  const BlackBox again = open(kBegin + 11 * kSecond);
  EXPECT_EQ(logs().size(), 2U);
}

TEST_F(BlackBoxTest, AStateThatComesAndGoesIsNotClosedEachTime) {
  BlackBox box = open();
  for (int second = 0; second < 20; ++second) {
    feed(box, second, second + 1);
    box.close_for_state("stop", kBegin + second * kSecond + 1);
  }
  // At 0, 6, 12 and 18 s.
  ASSERT_EQ(logs().size(), 4U);
  EXPECT_THAT(seconds_in(logs()[1]), ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST_F(BlackBoxTest, AMarkHoldsNoStateUp) {
  BlackBox box = open();
  feed(box, 0, 2);
  box.close("mark", kBegin + 2 * kSecond);
  feed(box, 2, 4);
  box.close_for_state("blind", kBegin + 4 * kSecond);
  ASSERT_EQ(logs().size(), 2U);
  EXPECT_THAT(logs()[1], EndsWith("_blind.lcm"));
}

TEST_F(BlackBoxTest, OnlySoManyLogsStay) {
  settings_.keep = 2;
  BlackBox box = open();
  for (int second = 0; second < 5; ++second) {
    feed(box, second, second + 1);
    box.close("mark", kBegin + second * kSecond);
  }
  ASSERT_EQ(logs().size(), 2U);
  EXPECT_THAT(seconds_in(logs()[1]), ElementsAre(4));
}

TEST_F(BlackBoxTest, AMarkClosesItOnce) {
  BlackBox box = open();
  feed(box, 0, 2);
  box.look_for_mark(kBegin + kSecond);
  EXPECT_THAT(logs(), IsEmpty());
  std::ofstream(folder_ / "mark") << "mark\n";
  box.look_for_mark(kBegin + 2 * kSecond);
  box.look_for_mark(kBegin + 3 * kSecond);
  ASSERT_EQ(logs().size(), 1U);
  EXPECT_THAT(logs()[0], EndsWith("_mark.lcm"));
  EXPECT_FALSE(fs::exists(folder_ / "mark"));
}

TEST_F(BlackBoxTest, AClockThatIsSetBackDoesNoHarm) {
  BlackBox box = open();
  feed(box, 10, 14);
  feed(box, 2, 5);
  box.close("mark", kBegin + 5 * kSecond);
  EXPECT_THAT(seconds_in(logs()[0]), ElementsAre(10, 11, 12, 13, 2, 3, 4));
}

TEST_F(BlackBoxTest, AFolderThatCannotBeIsRefused) {
  std::ofstream(folder_ / "file") << "x";
  settings_.folder = (folder_ / "file" / "box").string();
  const auto box = BlackBox::open(settings_, kBegin);
  ASSERT_FALSE(box);
  EXPECT_THAT(box.error().message, ::testing::HasSubstr("blackbox.folder"));
}

TEST_F(BlackBoxTest, AnotherOneDoesNotWriteInTheSameFolder) {
  BlackBox box = open();
  feed(box, 0, 5);
  const auto second = BlackBox::open(settings_, kBegin + 5 * kSecond);
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message, ::testing::HasSubstr("another screed"));
  EXPECT_THAT(logs(), ::testing::IsEmpty()) << "the first has not crashed";
}

TEST_F(BlackBoxTest, AFullDiskIsSaidAndComesBack) {
  BlackBox box = open();
  feed(box, 0, 1);
  fs::remove_all(folder_ / "ring");
  feed(box, 5, 6);  // begins a part where no folder is
  EXPECT_THAT(box.problem(), ::testing::HasSubstr("cannot write"));
  fs::create_directories(folder_ / "ring");
  feed(box, 10, 11);
  EXPECT_THAT(box.problem(), IsEmpty());
}

}  // namespace
}  // namespace scree
