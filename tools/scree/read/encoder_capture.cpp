#include "read/encoder_capture.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdio>

#include "commands.hpp"
#include "read/lidar_capture.hpp"
#include "scree/capture/capture.hpp"
#include "scree/drivers/encoder/dbc.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

using encoder::EncoderStream;

/// "N things refused, most of them: reason"
template <class Counts, class Reasons>
std::string refused(std::uint64_t count, std::string_view things, const Counts& by_reason,
                    const Reasons& reasons) {
  const auto most = std::max_element(by_reason.begin(), by_reason.end());
  return fmt::format("{} {} refused, most of them: {}", count, things,
                     reasons[static_cast<std::size_t>(most - by_reason.begin())]);
}

std::string refused_frames(const EncoderStream& stream) {
  const auto& counters = stream.counters();
  return refused(counters.all_refused(), "frames", counters.refused, encoder::kRefusalReasons);
}

std::string refused_lines(const CanLogReader& log) {
  const auto& counters = log.counters();
  return refused(counters.all_refused(), "lines", counters.refused, kCanLineReasons);
}

}  // namespace

EncoderSettings encoder_settings(const fs::path& capture, const fs::path& config) {
  return value_or_fail(encoder::with_dbc(capture_settings(capture, config).encoder,
                                         settings_file(capture, config).value_or(fs::path())));
}

EncoderCapture::EncoderCapture(const fs::path& capture, const EncoderSettings& settings,
                               const HostSteps& steps)
    : name_(capture.string()),
      log_(value_or_fail(CanLogReader::open(value_or_fail(can_file(capture))))),
      steady_(steps),
      settings_(settings) {}

void EncoderCapture::play_until(std::int64_t arrival_ns, EncoderStream& stream,
                                Progress* progress) {
  while (true) {
    if (!has_next_) {
      has_next_ = log_.next(next_, &interface_);
      if (has_next_) next_.t_ns = steady_(next_.t_ns);
    }
    if (!has_next_ || next_.t_ns > arrival_ns) return;
    has_next_ = false;
    if (progress != nullptr) (*progress)(log_.position());
    ++frames_[interface_];
    if (interface_ != settings_.interface) continue;
    span_.add(next_.t_ns);
    stream.take(next_);
  }
}

void EncoderCapture::play(EncoderStream& stream) {
  Progress progress(name_, fs::file_size(*can_file(name_)));
  play_until(INT64_MAX, stream, &progress);
}

void EncoderCapture::report(const EncoderStream& stream) const {
  const auto& counters = stream.counters();
  const auto counted = [&](encoder::Refusal reason) {
    return counters.refused[static_cast<std::size_t>(reason)];
  };
  using enum encoder::Refusal;
  const std::uint64_t read =
      counters.accepted + counted(time) + counted(implausible) + counted(frozen);
  if (read == 0) throw Failure(why_nothing(stream));
  if (log_.counters().has_differences()) {
    fmt::print(stderr,
               "scree: {}: its times are those since the frame before (candump -td): log with "
               "candump -L\n",
               name_);
  }
  if (log_.counters().all_refused() > 0) fmt::print(stderr, "scree: {}\n", refused_lines(log_));
  if (counters.all_refused() > 0) fmt::print(stderr, "scree: {}\n", refused_frames(stream));
  if (settings_.any_source && counters.other_source > 0) {
    fmt::print(
        stderr,
        "scree: {}: {} frames of the encoder's J1939 group come from another device "
        "(0x{:X}): the first device that sent is taken; name one by encoder.dbc's identifier\n",
        name_, counters.other_source, counters.last_other_source);
  }
}

/// What came nearest to the encoder's frames.
std::string EncoderCapture::like_it(const encoder::EncoderCounters& counters) const {
  if (counters.other_form > 0) {
    return fmt::format("; {} have it as {} one: set encoder.extended = {}", counters.other_form,
                       settings_.has_extended_id() ? "a standard (11-bit)" : "an extended (29-bit)",
                       !settings_.has_extended_id());
  }
  if (counters.other_source > 0) {
    return fmt::format("; {} of the same J1939 group come from another device (0x{:X})",
                       counters.other_source, counters.last_other_source);
  }
  return "";
}

std::string EncoderCapture::why_nothing(const EncoderStream& stream) const {
  if (settings_.interface.empty()) {
    return name_ + ": encoder.interface is empty: the encoder is switched off";
  }
  if (stream.counters().all_refused() > 0) {
    return fmt::format("{}: no signal: {}", name_, refused_frames(stream));
  }
  if (frames_.contains(settings_.interface)) {
    return fmt::format("{}: no frame with identifier 0x{:X}{} among the {} of {}{}", name_,
                       settings_.can_id, settings_.selector ? " and the signal's selector" : "",
                       stream.counters().other, settings_.interface, like_it(stream.counters()));
  }
  if (!frames_.empty()) {
    const auto& [interface, count] = *frames_.begin();
    return fmt::format("{}: no frame of {}, but {} of {}", name_, settings_.interface, count,
                       interface);
  }
  if (const std::string kind = other_kind(*can_file(name_)); !kind.empty()) {
    return fmt::format("{}: holds no CAN frame: can.log: {}", name_, kind);
  }
  if (log_.counters().all_refused() == 0) return name_ + ": holds no CAN frame";
  return fmt::format("{}: holds no CAN frame: {}", name_, refused_lines(log_));
}

}  // namespace scree::cli
