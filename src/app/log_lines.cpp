#include "log_lines.hpp"

#include <spdlog/fmt/fmt.h>

namespace scree {

void Growth::say(std::int64_t now_ns, std::uint64_t count, std::string_view what, LogLines& log) {
  constexpr std::int64_t kPause = 10'000'000'000;
  if (count == said_ || (said_ != 0 && now_ns - said_at_ns_ < kPause)) return;
  log.push_back(
      {true, fmt::format("{} ({} more, {} since the start)", what, count - said_, count)});
  said_ = count;
  said_at_ns_ = now_ns;
}

}  // namespace scree
