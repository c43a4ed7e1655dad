#include "common/time_range.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <limits>

namespace scree::cli {
namespace {

std::int64_t nanoseconds(double seconds) {
  return std::llround(seconds * 1e9);
}

}  // namespace

void TimeRange::add_to(CLI::App& command) {
  constexpr double kLongest = 1e9;
  command.add_option("--from", from_, "begin so many seconds after the capture's begin [0]")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, kLongest));
  command.add_option("--to", to_, "end so many seconds after the capture's begin [at its end]")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, kLongest));
}

void TimeRange::check() const {
  if (end_ns() <= begin_ns()) throw CLI::ValidationError("--to", "must be greater than --from");
}

std::int64_t TimeRange::begin_ns() const {
  return nanoseconds(from_);
}

std::int64_t TimeRange::end_ns() const {
  return to_ < 0 ? std::numeric_limits<std::int64_t>::max() : nanoseconds(to_);
}

std::string TimeRange::nothing_in(const std::string& capture, std::int64_t length_ns) const {
  return fmt::format("{} is {:.3f} s long: nothing is there from {:g} s {}", capture,
                     static_cast<double>(length_ns) * 1e-9, from_,
                     to_ < 0 ? "on" : fmt::format("to {:g} s", to_));
}

}  // namespace scree::cli
