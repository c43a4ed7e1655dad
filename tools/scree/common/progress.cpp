#include "common/progress.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace scree::cli {
namespace {

using Seconds = std::chrono::duration<double>;

// The first guess of the time left needs a while.
constexpr auto kFirstLook = std::chrono::milliseconds(500);
constexpr auto kPause = std::chrono::milliseconds(100);
constexpr double kShort = 2;  // seconds

/// As "2:05", or "7 s".
std::string time_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace

Progress::Progress(std::string work, std::size_t total)
    : work_(std::move(work)), total_(std::max<std::size_t>(total, 1)), next_(begin_ + kFirstLook) {}

Progress::~Progress() {
  if (is_written_) fmt::print(stderr, "\r\033[K");
}

bool Progress::is_shown() {
  return isatty(STDERR_FILENO) != 0;
}

void Progress::operator()(std::size_t done) {
  if (!is_shown_ || done == 0) return;
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + kPause;
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
  const double elapsed = Seconds(now - begin_).count();
  if (!is_written_ && elapsed / share < kShort) return;
  is_written_ = true;
  constexpr int kWidth = 30;
  const std::string bar(static_cast<std::size_t>(kWidth * share), '#');
  fmt::print(stderr, "\r{} [{:<30}] {:3.0f} %, {} left\033[K", work_, bar, std::floor(100 * share),
             time_text(elapsed / share - elapsed));
  std::fflush(stderr);
}

}  // namespace scree::cli
