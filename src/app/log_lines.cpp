#include "log_lines.hpp"

#include <spdlog/fmt/fmt.h>

namespace scree {

void GrowthLog::update(std::int64_t now_ns, std::uint64_t count, std::string_view what,
                       LogLines& log) {
  if (count == logged_ || (logged_ != 0 && now_ns - logged_at_ns_ < kLogPauseNs)) return;
  log.push_back(
      {true, fmt::format("{} ({} more, {} since the start)", what, count - logged_, count)});
  logged_ = count;
  logged_at_ns_ = now_ns;
}

}  // namespace scree
