#include "common/time_span.hpp"

#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>

#include <ctime>

namespace scree::cli {
namespace {

std::tm utc_of(std::int64_t time_ns) {
  return fmt::gmtime(static_cast<std::time_t>(time_ns / 1'000'000'000));
}

}  // namespace

std::string TimeSpan::text() const {
  return fmt::format("{:%Y-%m-%d %H:%M:%S} to {}", utc_of(first_ns), utc(last_ns));
}

std::string utc(std::int64_t time_ns) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", utc_of(time_ns));
}

}  // namespace scree::cli
