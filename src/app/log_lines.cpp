#include "log_lines.hpp"

#include <spdlog/fmt/fmt.h>

namespace scree {

void GrowthLog::add(std::int64_t now_ns, std::uint64_t count, std::string_view what,
                    LogLines& log) {
  log.push_back(
      {true, fmt::format("{} ({} more, {} since the start)", what, count - logged_, count)});
  logged_ = count;
  logged_at_ns_ = now_ns;
}

}  // namespace scree
