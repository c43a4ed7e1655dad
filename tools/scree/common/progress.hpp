#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace scree::cli {

/// A line on stderr that says how far a work is and how long it still takes, where stderr is a
/// terminal; nothing elsewhere, and nothing of a work of less than two seconds.
class Progress {
public:
  Progress(std::string work, std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void operator()(std::size_t done);

  /// Whether stderr is a terminal.
  static bool is_shown();

private:
  using Clock = std::chrono::steady_clock;

  std::string work_;
  std::size_t total_;
  const bool is_shown_ = is_shown();
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point next_;
  bool is_written_ = false;
};

}  // namespace scree::cli
