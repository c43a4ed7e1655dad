#include "live/lines_in_place.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <sstream>

namespace scree::cli {

std::string LinesInPlace::screen(int rows, int columns) const {
  constexpr const char *kHome = "\033[H", *kClearLine = "\033[K\n", *kClearBelow = "\033[J";
  std::string all = kHome;
  int left = rows - 1;  // the last one is the cursor's
  for (const std::string& text : texts_) {
    std::istringstream lines(text);
    for (std::string line; left > 0 && std::getline(lines, line); --left) {
      all += line.substr(0, static_cast<std::size_t>(columns)) + kClearLine;
    }
  }
  return all + kClearBelow;
}

std::pair<int, int> terminal_size() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row == 0) return {24, 80};
  return {size.ws_row, size.ws_col};
}

}  // namespace scree::cli
