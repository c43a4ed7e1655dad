#include "black_box.hpp"

#include <fcntl.h>
#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>
#include <sys/file.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <system_error>

#include "scree/core/nanoseconds.hpp"
#include "scree/publish/lcm_event.hpp"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMegabyte = 1'000'000;

std::int64_t nanoseconds_in(double seconds) {
  return std::llround(seconds * 1e9);
}

std::vector<fs::path> files_in(const fs::path& folder, std::string_view extension) {
  std::vector<fs::path> files;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(folder, unreadable)) {
    if (entry.path().extension() == extension) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// One log of all parts; whole or not at all. False when it cannot be written.
bool join(const std::vector<fs::path>& parts, const fs::path& log) {
  fs::path fresh = log;
  fresh.replace_extension(".new");
  std::error_code failed;
  {
    std::ofstream out(fresh, std::ios::binary);
    for (const fs::path& part : parts) {
      std::ifstream in(part, std::ios::binary);
      if (in.peek() != std::ifstream::traits_type::eof()) out << in.rdbuf();
    }
    if (!out.flush()) {
      fs::remove(fresh, failed);
      return false;
    }
  }
  fs::rename(fresh, log, failed);
  if (failed) return false;
  for (const fs::path& part : parts) fs::remove(part, failed);
  return true;
}

/// FOLDER/2026-11-27T18-12-00.500_REASON.lcm
fs::path log_name(const fs::path& folder, std::string_view reason, std::int64_t now_ns) {
  const auto time = fmt::gmtime(static_cast<std::time_t>(now_ns / kSecond));
  return folder / fmt::format("{:%Y-%m-%dT%H-%M-%S}.{:03}_{}.lcm", time,
                              now_ns % kSecond / 1'000'000, reason);
}

}  // namespace

BlackBox::BlackBox(const BlackBoxSettings& settings)
    : settings_(settings), folder_(settings.folder), ring_(folder_ / "ring") {}

Result<BlackBox> BlackBox::open(const BlackBoxSettings& settings, std::int64_t now_ns) {
  BlackBox box(settings);
  std::error_code failed;
  fs::create_directories(box.ring_, failed);
  if (failed) {
    return fail(fmt::format("blackbox.folder: {} cannot be made: {}", box.ring_.string(),
                            failed.message()));
  }
  box.lock_ = Descriptor(::open(box.ring_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (flock(box.lock_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    return fail(fmt::format("blackbox.folder: another screed writes in {}: give each a folder",
                            box.folder_.string()));
  }
  if (const auto closed = box.close_leftovers(now_ns); !closed) {
    return tl::make_unexpected(closed.error());
  }
  return box;
}

Result<void> BlackBox::close_leftovers(std::int64_t now_ns) {
  const std::vector<fs::path> left = files_in(ring_, ".part");
  std::error_code failed;
  const bool is_empty = std::ranges::all_of(
      left, [&](const fs::path& part) { return fs::file_size(part, failed) == 0; });
  if (is_empty) {
    for (const fs::path& part : left) fs::remove(part, failed);
  } else if (!join(left, log_name(folder_, "crash", now_ns))) {
    return fail("blackbox.folder: cannot write in " + folder_.string());
  }
  fs::remove(folder_ / kMarkFile, failed);  // an old one asks for nothing
  forget_oldest_logs();
  return {};
}

void BlackBox::take(std::string_view channel, std::int64_t now_ns,
                    std::span<const std::uint8_t> message) {
  const std::int64_t part_ns = nanoseconds_in(settings_.seconds) / kParts;
  const std::uint64_t part_bytes =
      static_cast<std::uint64_t>(settings_.megabytes) * kMegabyte / kParts;
  // A wall clock that was set back begins a part too.
  if (parts_.empty() || now_ns < parts_.back().begin_ns ||
      now_ns >= parts_.back().begin_ns + part_ns || parts_.back().bytes >= part_bytes) {
    begin_part(now_ns);
  }
  event_.clear();
  append_lcm_event(events_++, now_ns / 1000, channel, message, event_);
  // Flushed, so that the file has it whatever becomes of this program.
  file_.write(reinterpret_cast<const char*>(event_.data()),
              static_cast<std::streamsize>(event_.size()));
  if (!file_.flush()) {
    fail_with("cannot write in " + ring_.string());
    return;
  }
  problem_.clear();
  parts_.back().bytes += event_.size();
}

void BlackBox::begin_part(std::int64_t now_ns) {
  file_.close();
  file_.clear();
  parts_.push_back({ring_ / fmt::format("{:012}.part", next_part_++), now_ns, 0});
  file_.open(parts_.back().file, std::ios::binary | std::ios::trunc);
  let_fall_out(now_ns);
}

void BlackBox::let_fall_out(std::int64_t now_ns) {
  std::uint64_t bytes = 0;
  for (const Part& part : parts_) bytes += part.bytes;
  const std::uint64_t most = static_cast<std::uint64_t>(settings_.megabytes) * kMegabyte;
  const std::int64_t oldest_ns = now_ns - nanoseconds_in(settings_.seconds);
  // A part goes when the one after it is old enough alone.
  while (parts_.size() > 1 && (bytes > most || parts_[1].begin_ns <= oldest_ns)) {
    bytes -= parts_.front().bytes;
    std::error_code gone;
    fs::remove(parts_.front().file, gone);
    parts_.pop_front();
  }
}

void BlackBox::close_for_state(std::string_view reason, std::int64_t now_ns) {
  const std::int64_t pause_ns = nanoseconds_in(settings_.seconds) / 2;
  if (closed_ns_ && now_ns >= *closed_ns_ && now_ns < *closed_ns_ + pause_ns) return;
  close(reason, now_ns);
  closed_ns_ = now_ns;
}

void BlackBox::close(std::string_view reason, std::int64_t now_ns) {
  if (parts_.empty()) return;
  file_.close();
  std::vector<fs::path> files;
  for (const Part& part : parts_) files.push_back(part.file);
  parts_.clear();
  if (!join(files, log_name(folder_, reason, now_ns))) {
    fail_with("cannot write in " + folder_.string());
    std::error_code gone;
    for (const fs::path& file : files) fs::remove(file, gone);
  }
  forget_oldest_logs();
}

void BlackBox::look_for_mark(std::int64_t now_ns) {
  const fs::path mark = folder_ / kMarkFile;
  std::error_code none;
  if (!fs::exists(mark, none)) return;
  close("mark", now_ns);
  fs::remove(mark, none);
}

void BlackBox::forget_oldest_logs() {
  std::vector<fs::path> logs = files_in(folder_, ".lcm");
  const auto keep = static_cast<std::size_t>(settings_.keep);
  std::error_code gone;
  for (std::size_t i = 0; i + keep < logs.size(); ++i) fs::remove(logs[i], gone);
}

void BlackBox::fail_with(const std::string& what) {
  problem_ = "the black box " + what + ": is the disk full?";
}

}  // namespace scree
