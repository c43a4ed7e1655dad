#pragma once

#include <cstddef>
#include <string>

namespace scree::cli {

/// A line on stderr that says how far a work is, where stderr is a terminal; nothing elsewhere.
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
  std::string work_;
  std::size_t total_;
  std::size_t percent_ = 101;
  const bool is_shown_ = is_shown();
};

}  // namespace scree::cli
