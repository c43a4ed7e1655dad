#include "app/log_writer.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <string>

#include "scree/core/descriptor.hpp"

namespace scree {
namespace {

using std::chrono::milliseconds;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A pipe that somebody reads, or nobody.
class LogWriterTest : public testing::Test {
protected:
  LogWriterTest() {
    int ends[2];
    EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
    read_end_ = Descriptor(ends[0]);
    write_end_ = Descriptor(ends[1]);
  }
  /// What comes out of the pipe until nothing has come for half a second.
  std::string read_all() {
    fcntl(read_end_.get(), F_SETFL, O_NONBLOCK);
    std::string text;
    char buffer[4096];
    for (int pauses = 0; pauses < 50;) {
      const ssize_t size = read(read_end_.get(), buffer, sizeof buffer);
      if (size > 0) {
        text.append(buffer, static_cast<std::size_t>(size));
        pauses = 0;
      } else {
        ++pauses;
        usleep(10'000);
      }
    }
    return text;
  }

  Descriptor read_end_, write_end_;
};

TEST_F(LogWriterTest, LinesComeInOrder) {
  const auto writer = LogWriter::start(write_end_.get());
  writer->write("one\n");
  writer->write("two\n");
  EXPECT_TRUE(writer->finish(std::chrono::seconds(60)));
  EXPECT_EQ(read_all(), "one\ntwo\n");
}

TEST_F(LogWriterTest, NobodyWaitsForAReaderThatStallsAndWhatIsDroppedIsCounted) {
  const auto writer = LogWriter::start(write_end_.get());
  const std::string line = std::string(999, 'x') + '\n';
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < LogWriter::kWaiting + 1000; ++i) writer->write(line);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  const std::string text = read_all();
  EXPECT_THAT(text, StartsWith(line));
  EXPECT_THAT(text, EndsWith(" lines of this log were dropped: nobody read it\n"));
  const std::size_t written = std::count(text.begin(), text.end(), '\n') - 1;
  const std::size_t dropped = LogWriter::kWaiting + 1000 - written;
  EXPECT_THAT(text, HasSubstr('\n' + std::to_string(dropped) + " lines of this log"));
  writer->write("again\n");
  EXPECT_TRUE(writer->finish(std::chrono::seconds(60)));
  EXPECT_EQ(read_all(), "again\n");
}

TEST_F(LogWriterTest, TheEndDoesNotWaitForAReaderThatStalls) {
  const auto writer = LogWriter::start(write_end_.get());
  for (int i = 0; i < 150; ++i) writer->write(std::string(999, 'x') + '\n');
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(writer->finish(milliseconds(100)));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  read_all();
}

TEST_F(LogWriterTest, WhereTheReaderIsGoneLinesAreLost) {
  std::signal(SIGPIPE, SIG_IGN);
  const auto writer = LogWriter::start(write_end_.get());
  read_end_ = Descriptor();
  for (int i = 0; i < 20; ++i) writer->write(std::string(999, 'x') + '\n');
  EXPECT_TRUE(writer->finish(std::chrono::seconds(60)));
}

}  // namespace
}  // namespace scree
