#include "log_writer.hpp"

#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <thread>
#include <utility>

namespace scree {

std::shared_ptr<LogWriter> LogWriter::start(int descriptor) {
  std::shared_ptr<LogWriter> writer(new LogWriter(descriptor));
  std::thread thread([writer] { writer->run(); });
  pthread_setname_np(thread.native_handle(), "log");
  thread.detach();
  return writer;
}

void LogWriter::write(std::string line) {
  const std::scoped_lock lock(lines_mutex_);
  if (lines_.size() >= kWaiting) {
    ++dropped_;
    return;
  }
  lines_.push_back(std::move(line));
  changed_.notify_all();
}

void LogWriter::sink_it_(const spdlog::details::log_msg& message) {
  spdlog::memory_buf_t line;
  formatter_->format(message, line);
  write({line.data(), line.size()});
}

bool LogWriter::finish(std::chrono::milliseconds longest) {
  std::unique_lock lock(lines_mutex_);
  const bool is_written =
      changed_.wait_for(lock, longest, [this] { return lines_.empty() && !is_writing_; });
  is_finished_ = true;
  changed_.notify_all();
  return is_written;
}

void LogWriter::run() {
  std::unique_lock lock(lines_mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_finished_ || !lines_.empty(); });
    if (is_finished_) return;
    const std::string line = next_line();
    is_writing_ = true;
    lock.unlock();
    write_out(line);
    lock.lock();
    is_writing_ = false;
    changed_.notify_all();
  }
}

/// With what was dropped behind it: all lines before that are older.
std::string LogWriter::next_line() {
  std::string line = std::move(lines_.front());
  lines_.pop_front();
  if (lines_.empty() && dropped_ != 0) {
    line += std::to_string(std::exchange(dropped_, 0)) +
            " lines of this log were dropped: nobody read it\n";
  }
  return line;
}

/// Where nobody will read any more, the rest is lost.
void LogWriter::write_out(const std::string& line) {
  std::string_view rest = line;
  while (!rest.empty()) {
    pollfd wait_for{descriptor_, POLLOUT, 0};
    if (poll(&wait_for, 1, -1) < 0) continue;  // a signal came between
    // A pipe that poll() calls writable takes as much without blocking.
    const ssize_t size =
        ::write(descriptor_, rest.data(), std::min<std::size_t>(rest.size(), PIPE_BUF));
    if (size < 0 && errno != EINTR && errno != EAGAIN) return;
    if (size > 0) rest.remove_prefix(static_cast<std::size_t>(size));
  }
}

}  // namespace scree
