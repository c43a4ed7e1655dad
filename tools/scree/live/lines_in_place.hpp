#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>

namespace scree::cli {

/// Texts that stand below one another on a terminal, each in the place of the one before it.
class LinesInPlace {
public:
  static constexpr std::size_t kTexts = 3;

  void set(std::size_t text, std::string lines) { texts_.at(text) = std::move(lines); }
  /// What to write on a terminal of that size. What has no room is left out.
  std::string screen(int rows, int columns) const;

private:
  std::array<std::string, kTexts> texts_;
};

/// Rows and columns of the terminal that standard output is; 24 and 80 where it does not say.
std::pair<int, int> terminal_size();

}  // namespace scree::cli
