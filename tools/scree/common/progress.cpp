#include "common/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace scree::cli {

Progress::Progress(std::string work, std::size_t total)
    : work_(std::move(work)), total_(std::max<std::size_t>(total, 1)) {}

Progress::~Progress() {
  if (is_shown_) std::fprintf(stderr, "\r\033[K");
}

bool Progress::is_shown() {
  return isatty(STDERR_FILENO) != 0;
}

void Progress::operator()(std::size_t done) {
  const std::size_t percent = std::min<std::size_t>(100 * done / total_, 100);
  if (!is_shown_ || percent == percent_) return;
  percent_ = percent;
  constexpr std::size_t kWidth = 30;
  const std::string bar(kWidth * percent / 100, '#');
  std::fprintf(stderr, "\r%s [%-30s] %3zu %%", work_.c_str(), bar.c_str(), percent);
}

}  // namespace scree::cli
