#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

namespace scree::cli {

/// A part of a capture, as the options --from and --to give it: seconds from the first arrival of
/// any sensor, the end not included.
class TimeRange {
public:
  void add_to(CLI::App& command);
  /// Throws CLI::ValidationError for an empty one.
  void check() const;

  std::int64_t begin_ns() const;
  /// The greatest number where the end is open.
  std::int64_t end_ns() const;
  bool holds(std::int64_t since_start_ns) const {
    return since_start_ns >= begin_ns() && since_start_ns < end_ns();
  }
  /// One sentence for a capture of that length that has nothing there.
  std::string nothing_in(const std::string& capture, std::int64_t length_ns) const;

private:
  double from_ = 0, to_ = -1;
};

}  // namespace scree::cli
