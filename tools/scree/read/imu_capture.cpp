#include "read/imu_capture.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdio>

#include "commands.hpp"
#include "scree/capture/capture.hpp"

namespace scree::cli {
namespace {

using xsens::ImuCounters;
using xsens::ImuStream;

constexpr int kSerialLink = 147;  // DLT_USER0

/// "3 wrong checksum, 1 duplicate".
std::string refusals(const ImuCounters& counters) {
  std::string text;
  for (std::size_t i = 0; i < xsens::kRefusals; ++i) {
    if (counters.refused[i] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counters.refused[i],
                        xsens::kRefusalReasons[i]);
  }
  return text;
}

}  // namespace

PcapReader open_imu(const std::filesystem::path& capture) {
  auto reader = value_or_fail(PcapReader::open(value_or_fail(imu_file(capture))));
  if (reader.link_type() != kSerialLink) {
    throw Failure(fmt::format("{}: holds no serial bytes (link type {}, not {})", capture.string(),
                              reader.link_type(), kSerialLink));
  }
  return reader;
}

ImuCapture::ImuCapture(const std::filesystem::path& capture, const HostSteps& steps)
    : name_(capture.string()), reader_(open_imu(capture)), steady_(steps) {}

void ImuCapture::play_until(std::int64_t arrival_ns, ImuStream& stream, Progress* progress) {
  while (true) {
    if (!has_next_) {
      has_next_ = reader_.next(next_);
      if (has_next_) next_.arrival_ns = steady_(next_.arrival_ns);
    }
    if (!has_next_ || next_.arrival_ns > arrival_ns) return;
    has_next_ = false;
    if (progress != nullptr) (*progress)(reader_.position());
    if (reads_++ == 0) first_ns_ = next_.arrival_ns;
    last_ns_ = next_.arrival_ns;
    bytes_ += next_.bytes.size();
    stream.take(next_.bytes, next_.arrival_ns);
  }
}

void ImuCapture::play(ImuStream& stream) {
  Progress progress(name_, std::filesystem::file_size(*imu_file(name_)));
  play_until(INT64_MAX, stream, &progress);
  stream.flush();
}

double ImuCapture::seconds() const {
  return static_cast<double>(last_ns_ - first_ns_) * 1e-9;
}

std::string ImuCapture::why_nothing(const ImuStream& stream) const {
  const ImuCounters& counters = stream.counters();
  if (bytes_ == 0) return fmt::format("{}: the file holds no bytes", name_);
  if (counters.all_refused() > 0) {
    return fmt::format("{}: nothing of its {} bytes is accepted: {}", name_, bytes_,
                       refusals(counters));
  }
  if (counters.other_messages > 0) {
    return fmt::format("{}: {} Xbus messages, but none with measurements (MTData2)", name_,
                       counters.other_messages);
  }
  return fmt::format("{}: no Xbus message in {} bytes", name_, bytes_);
}

void report_capture(const ImuCapture& capture, const ImuStream& stream) {
  const ImuCounters& counters = stream.counters();
  const auto note = [](const std::string& text) {
    if (!text.empty()) fmt::print(stderr, "scree: {}\n", text);
  };
  note(capture.broken_off());
  if (counters.accepted == 0) throw Failure(capture.why_nothing(stream));
  if (counters.all_refused() > 0) note("refused: " + refusals(counters));
  if (counters.bytes_skipped > 0) {
    note(fmt::format("{} bytes belong to no message", counters.bytes_skipped));
  }
  if (counters.lost > 0) note(fmt::format("{} messages are missing", counters.lost));
  if (counters.unknown_items > 0) {
    note(fmt::format("{} values of unknown kinds", counters.unknown_items));
  }
}

}  // namespace scree::cli
