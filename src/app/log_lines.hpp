#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "scree/core/nanoseconds.hpp"

namespace scree {

/// What a person should read in the log.
struct LogLine {
  bool is_warning;
  std::string text;
};
using LogLines = std::vector<LogLine>;

/// Lines about the same thing are at least so far apart: a lasting fault must not fill the log.
inline constexpr std::int64_t kLogPauseNs = 10 * kSecond;

/// Logs a count when it has grown, but not more often than every kLogPauseNs.
class GrowthLog {
public:
  /// @param what is the text, or a function that makes it: most of the time it is not needed
  template <class What>
  void update(std::int64_t now_ns, std::uint64_t count, const What& what, LogLines& log) {
    if (count == logged_ || (logged_ != 0 && now_ns - logged_at_ns_ < kLogPauseNs)) return;
    if constexpr (std::is_invocable_v<What>) {
      add(now_ns, count, what(), log);
    } else {
      add(now_ns, count, what, log);
    }
  }

private:
  void add(std::int64_t now_ns, std::uint64_t count, std::string_view what, LogLines& log);

  std::uint64_t logged_ = 0;
  std::int64_t logged_at_ns_ = 0;
};

}  // namespace scree
