#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// What is worth a line in the log.
struct LogLine {
  bool is_warning;
  std::string text;
};
using LogLines = std::vector<LogLine>;

/// A count that is worth a line when it has grown, but not more often than every ten seconds.
class Growth {
public:
  void say(std::int64_t now_ns, std::uint64_t count, std::string_view what, LogLines& log);

private:
  std::uint64_t said_ = 0;
  std::int64_t said_at_ns_ = 0;
};

}  // namespace scree
