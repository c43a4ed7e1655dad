#include "scree/capture/can_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>
#include <random>

#include "scree/capture/capture.hpp"
#include "scree/core/nanoseconds.hpp"
#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The frame of one line, which must be a good one.
CanFrame frame_of(std::string_view line) {
  CanFrame frame;
  std::string_view interface;
  EXPECT_EQ(parse_can_line(line, frame, interface), CanLineRefusal::none) << line;
  return frame;
}

CanLineRefusal refusal_of(std::string_view line) {
  CanFrame frame;
  std::string_view interface;
  return parse_can_line(line, frame, interface);
}

std::vector<int> data_of(const CanFrame& frame) {
  return {frame.payload().begin(), frame.payload().end()};
}

TEST(CanLine, ReadsAClassicFrame) {
  CanFrame frame;
  std::string_view interface;
  ASSERT_EQ(parse_can_line("(1598601600.123456) can0 1A0#00112233AAbbCCdd", frame, interface),
            CanLineRefusal::none);
  EXPECT_EQ(interface, "can0");
  EXPECT_EQ(frame.t_ns, 1'598'601'600'123'456'000);
  EXPECT_EQ(frame.id, 0x1A0U);
  EXPECT_FALSE(frame.is_extended || frame.is_error || frame.is_remote);
  EXPECT_THAT(data_of(frame), ElementsAre(0, 0x11, 0x22, 0x33, 0xAA, 0xBB, 0xCC, 0xDD));
  EXPECT_THAT(data_of(frame_of("(1.0) can0 7FF#")), ElementsAre());
  EXPECT_THAT(data_of(frame_of("(1.0) can0 7FF#11.22.33")), ElementsAre(0x11, 0x22, 0x33));
  EXPECT_EQ(frame_of("(1.0) can0 123#1122334455667788_9").size, 8);
}

TEST(CanLine, ReadsIdentifiersOf29BitsByTheirEightDigits) {
  const CanFrame frame = frame_of("(1.0) vcan0 18FF50E5#01");
  EXPECT_EQ(frame.id, 0x18FF50E5U);
  EXPECT_TRUE(frame.is_extended);
  const CanFrame low = frame_of("(1.0) vcan0 000001A0#01");
  EXPECT_EQ(low.id, 0x1A0U);
  EXPECT_TRUE(low.is_extended);
}

TEST(CanLine, ReadsErrorAndRemoteFrames) {
  const CanFrame error = frame_of("(1.0) can0 20000040#0000000000000000");
  EXPECT_TRUE(error.is_error);
  EXPECT_FALSE(error.is_extended);
  EXPECT_EQ(error.id, 0x40U);
  const CanFrame remote = frame_of("(1.0) can0 1A0#R4");
  EXPECT_TRUE(remote.is_remote);
  EXPECT_EQ(remote.size, 4);
  EXPECT_THAT(data_of(remote), ElementsAre());
  EXPECT_TRUE(frame_of("(1.0) can0 1A0#R").is_remote);
}

TEST(CanLine, ReadsWhatCandumpWritesForPeople) {
  CanFrame frame;
  std::string_view interface;
  ASSERT_EQ(parse_can_line(" (1598612522.753742)  can0  1A0   [4]  A0 86 01 00", frame, interface),
            CanLineRefusal::none);
  EXPECT_EQ(interface, "can0");
  EXPECT_EQ(frame.t_ns, 1'598'612'522'753'742'000);
  EXPECT_EQ(frame.id, 0x1A0U);
  EXPECT_THAT(data_of(frame), ElementsAre(0xA0, 0x86, 1, 0));
  EXPECT_THAT(data_of(frame_of(" (1.0)  can0  18FF50E5   [2]  01 23   '.#'")),
              ElementsAre(1, 0x23));
  EXPECT_THAT(data_of(frame_of(" (1.0)  can0  TX - -  1A0   [1]  07\r")), ElementsAre(7));
  EXPECT_TRUE(frame_of(" (1.0)  can0  1A0   [4]  remote request").is_remote);
  EXPECT_TRUE(frame_of(" (1.0)  can0  20000040   [1]  00   ERRORFRAME").is_error);
  EXPECT_EQ(frame_of(" (1.0)  can0  1A0  [00] ").size, 0);
  EXPECT_EQ(refusal_of(" (1.0)  can0  1A0   [4]  A0 86 01"), CanLineRefusal::data);
  EXPECT_EQ(refusal_of(" (1.0)  can0  1A0   [99]  A0"), CanLineRefusal::data);
  EXPECT_EQ(refusal_of(" (1.0)  can0  1A0   [2]  A0 8"), CanLineRefusal::data);
  EXPECT_EQ(refusal_of(" (1.0)  can0  1A0   A0 86"), CanLineRefusal::form);
  EXPECT_EQ(refusal_of("  can0  1A0   [1]  A0"), CanLineRefusal::form) << "without a time";
  EXPECT_EQ(refusal_of(" (2020-08-28 11:02:02.753742)  can0  1A0   [1]  A0"), CanLineRefusal::none);
}

TEST(CanLine, ReadsFdFrames) {
  std::string line = "(1.0) can0 1A0##3";
  for (int i = 0; i < 64; ++i) line += "5A";
  EXPECT_EQ(frame_of(line).size, 64);
  EXPECT_EQ(frame_of(line).data[63], 0x5A);
  EXPECT_THAT(data_of(frame_of("(1.0) can0 1A0##0")), ElementsAre());
  EXPECT_EQ(refusal_of(line + "5A"), CanLineRefusal::data);
}

TEST(CanLine, ReadsFractionsOfAnyLengthAndLineEnds) {
  EXPECT_EQ(frame_of("(5.123456789) can0 1A0#01").t_ns, 5'123'456'789);
  EXPECT_EQ(frame_of("(5.1) can0 1A0#01").t_ns, 5'100'000'000);
  EXPECT_EQ(frame_of("(0000000005.000001) can0 1A0#01\r").t_ns, 5'000'001'000);
  EXPECT_EQ(frame_of("(5.1) can0 1A0#01 R").size, 1);
  EXPECT_EQ(frame_of("(5.1) can0 1A0#01 T\r").size, 1);
}

TEST(CanLine, ReadsDatesOfThePlaceWhereItIsRead) {
  std::tm date{};
  date.tm_year = 2023 - 1900;
  date.tm_mon = 10;
  date.tm_mday = 14;
  date.tm_hour = 22;
  date.tm_min = 13;
  date.tm_sec = 20;
  date.tm_isdst = -1;
  const std::int64_t seconds = std::mktime(&date);
  EXPECT_EQ(frame_of("(2023-11-14 22:13:20.000002) can0 1A0#01").t_ns, seconds * kSecond + 2000);
  for (const char* line : {"(2023-11-14.5) can0 1A0#01", "(2023-11-14 22:13.5) can0 1A0#01",
                           "(1823-11-14 22:13:20.5) can0 1A0#01", "(-:.5) can0 1A0#01"}) {
    EXPECT_EQ(refusal_of(line), CanLineRefusal::time) << line;
  }
}

TEST(CanLine, SaysWhatIsWrong) {
  for (const char* line : {"", "x", "can0 1A0#01", "(1.0)can0 1A0#01", "(1.0) 1A0#01",
                           "(1.0) can0 1A0", "(1.0 can0 1#0", "(1.0) can0  1A0", "(1.0)  1A0#01"}) {
    EXPECT_EQ(refusal_of(line), CanLineRefusal::form) << line;
  }
  for (const char* time : {"", ".", "1", "1.", ".1", "-1.0", "1.-1", "1.0000000001", "a.b",
                           "99999999999999999999.0", "9300000000.0", "1 .0"}) {
    EXPECT_EQ(refusal_of(std::string("(").append(time).append(") can0 1A0#01")),
              CanLineRefusal::time)
        << time;
  }
  for (const char* id :
       {"", "1A", "800", "FFF", "1A0B", "80000000", "60000000", "123456789", "G00", "-01"}) {
    EXPECT_EQ(refusal_of(std::string("(1.0) can0 ").append(id).append("#01")),
              CanLineRefusal::identifier)
        << id;
  }
  for (const char* data : {"1", "123", "0G", "112233445566778899", "01.", "01..02", ".", "R9", "RR",
                           "#", "#G", "#01", "1122334455667788_", "1122_9", "-1"}) {
    EXPECT_EQ(refusal_of(std::string("(1.0) can0 1A0#").append(data)), CanLineRefusal::data)
        << data;
  }
  EXPECT_EQ(refusal_of("(1.0) can0 20000040#R"), CanLineRefusal::data);
}

TEST(CanLogReader, PassesOverAndCountsWhatItCannotRead) {
  const TemporaryFolder folder;
  const std::string text = "(1.0) can0 1A0#01\r\n\n# a note\ngarbage\n(2.0) can1 1A0#0\n" +
                           std::string(5000, 'x') + "\n" + std::string("(3.0)\0 c", 8) +
                           "\n(4.0) can1 18FF50E5#0203";
  auto reader = CanLogReader::open(folder.write("can.log", text));
  ASSERT_TRUE(reader);
  CanFrame frame;
  std::string interface;
  ASSERT_TRUE(reader->next(frame, &interface));
  EXPECT_EQ(interface, "can0");
  ASSERT_TRUE(reader->next(frame, &interface));
  EXPECT_EQ(interface, "can1");
  EXPECT_EQ(frame.id, 0x18FF50E5U);
  EXPECT_FALSE(reader->next(frame));
  EXPECT_FALSE(reader->next(frame));
  EXPECT_EQ(reader->counters().frames, 2U);
  EXPECT_THAT(reader->counters().refused, ElementsAre(0, 3, 0, 0, 1));
}

TEST(CanLogReader, TakesAnyBytes) {
  const TemporaryFolder folder;
  std::mt19937 random(1);
  const std::string_view alphabet = "(1.0) can0 1A0#01R#\n\r\0_.x";
  std::string text;
  for (int i = 0; i < 200'000; ++i) text += alphabet[random() % alphabet.size()];
  for (int i = 0; i < 100'000; ++i) text += static_cast<char>(random());
  auto reader = CanLogReader::open(folder.write("can.log", text));
  ASSERT_TRUE(reader);
  CanFrame frame;
  while (reader->next(frame)) EXPECT_LE(frame.size, 64);
  EXPECT_GT(reader->counters().all_refused(), 1000U);
}

TEST(CanLogReader, AMissingFileIsOneSentence) {
  const auto reader = CanLogReader::open("/nonexistent/can.log");
  ASSERT_FALSE(reader);
  EXPECT_THAT(reader.error().message, HasSubstr("/nonexistent/can.log"));
  EXPECT_FALSE(CanLogReader::open("/"));
}

TEST(CanLogReader, TextOf16BitsIsNamed) {
  const TemporaryFolder folder;
  const auto reader = CanLogReader::open(folder.write("can.log", std::string("\xFF\xFE(\0", 4)));
  ASSERT_FALSE(reader);
  EXPECT_THAT(reader.error().message, HasSubstr("UTF-16"));
}

TEST(CanFile, OtherRecordingsInTheFolderAreNamed) {
  const TemporaryFolder folder;
  folder.write("candump-2020-08-28_110200.log", "x");
  folder.write("scree.toml", "");
  EXPECT_THAT(can_file(folder.path()).error().message,
              AllOf(HasSubstr("no can.log"), HasSubstr("it has candump-2020-08-28_110200.log")));
}

TEST(CanFile, IsTheCaptureOrInItsFolder) {
  const TemporaryFolder folder;
  EXPECT_THAT(can_file(folder / "").error().message, HasSubstr("has no can.log"));
  EXPECT_THAT(can_file(folder / "none").error().message, HasSubstr("no such file or folder"));
  const auto log = folder.write("can.log", "");
  EXPECT_EQ(can_file(folder / "").value(), log);
  EXPECT_EQ(can_file(log).value(), log);
}

TEST(CanLogWriter, WritesAsCandumpAndReadsBack) {
  const TemporaryFolder folder;
  CanFrame data, remote, error, extended, fd;
  data.t_ns = 1'598'601'600'000'012'000;
  data.id = 0x0C8;
  data.size = 3;
  data.data = {0x0A, 0xBC, 0x00};
  remote.id = 0x7FF;
  remote.is_remote = true;
  remote.size = 2;
  error.id = 0x40;
  error.is_error = true;
  error.size = 8;
  extended.id = 0x1A0;
  extended.is_extended = true;
  fd.id = 0x1A0;
  fd.size = 12;
  const std::vector<CanFrame> frames = {data, remote, error, extended, fd};
  auto writer = CanLogWriter::create(folder / "can.log");
  ASSERT_TRUE(writer);
  for (const CanFrame& frame : frames) writer->write(frame, "can0");
  ASSERT_TRUE(writer->close());
  EXPECT_EQ(bytes_of(folder / "can.log"),
            "(1598601600.000012) can0 0C8#0ABC00\n(0000000000.000000) can0 7FF#R2\n"
            "(0000000000.000000) can0 20000040#0000000000000000\n"
            "(0000000000.000000) can0 000001A0#\n"
            "(0000000000.000000) can0 1A0##0000000000000000000000000\n");
  auto reader = CanLogReader::open(folder / "can.log");
  ASSERT_TRUE(reader);
  CanFrame frame;
  for (const CanFrame& written : frames) {
    ASSERT_TRUE(reader->next(frame));
    EXPECT_EQ(std::tie(frame.t_ns, frame.id, frame.is_extended, frame.is_error, frame.is_remote,
                       frame.size, frame.data),
              std::tie(written.t_ns, written.id, written.is_extended, written.is_error,
                       written.is_remote, written.size, written.data));
  }
}

TEST(CanLogWriter, AFullDiskShows) {
  auto writer = CanLogWriter::create("/dev/full");
  ASSERT_TRUE(writer);
  writer->write({}, "can0");
  EXPECT_FALSE(writer->flush());
  EXPECT_FALSE(writer->close());
  EXPECT_FALSE(CanLogWriter::create("/nonexistent/can.log"));
}

}  // namespace
}  // namespace scree
