#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

namespace scree::cli {

/// From the first to the last of some times, host time in nanoseconds.
struct TimeSpan {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();

  bool empty() const { return first_ns > last_ns; }
  void add(std::int64_t t_ns) {
    first_ns = std::min(first_ns, t_ns);
    last_ns = std::max(last_ns, t_ns);
  }
  bool meets(const TimeSpan& other) const {
    return first_ns <= other.last_ns && other.first_ns <= last_ns;
  }
  /// As "2020-08-28 11:02:02 to 2020-08-28 11:02:05 UTC".
  std::string text() const;
};

/// As "2020-08-28 11:02:02 UTC".
std::string utc(std::int64_t time_ns);

}  // namespace scree::cli
