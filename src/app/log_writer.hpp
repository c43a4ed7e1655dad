#pragma once

#include <spdlog/sinks/base_sink.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>

namespace scree {

/// Writes the log to a descriptor in a thread of its own, so that no other thread waits for whoever
/// reads it: a terminal may be stopped (Ctrl-S), a pipe full. Where kWaiting lines wait, the newest
/// are dropped; how many is written as soon as somebody reads again. Any thread may log.
class LogWriter final : public spdlog::sinks::base_sink<std::mutex> {
public:
  static constexpr std::size_t kWaiting = 200;

  /// Starts the thread, which keeps the object alive: one that hangs in a write is left behind.
  static std::shared_ptr<LogWriter> start(int descriptor);

  /// A line of its own, as it is.
  void write(std::string line);
  /// Gives the thread so long to write what waits, and ends it; false when lines are left.
  bool finish(std::chrono::milliseconds longest);

protected:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}

private:
  explicit LogWriter(int descriptor) : descriptor_(descriptor) {}
  void run();
  std::string next_line();
  void write_out(const std::string& line);

  const int descriptor_;
  std::mutex lines_mutex_;
  std::condition_variable changed_;
  std::deque<std::string> lines_;
  std::uint64_t dropped_ = 0;
  bool is_writing_ = false, is_finished_ = false;
};

}  // namespace scree
