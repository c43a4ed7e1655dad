#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "common/progress.hpp"
#include "common/time_span.hpp"
#include "read/host_steps.hpp"
#include "scree/capture/can_log.hpp"
#include "scree/config/settings.hpp"
#include "scree/drivers/encoder/encoder_stream.hpp"

namespace scree::cli {

/// The encoder's settings of a capture, with what their DBC file says: see capture_settings().
/// Throws Failure.
EncoderSettings encoder_settings(const std::filesystem::path& capture,
                                 const std::filesystem::path& config);

/// The encoder's part of a capture, and what was seen of it while it was played.
class EncoderCapture {
public:
  /// @param steps taken out of all times
  /// Throws Failure.
  EncoderCapture(const std::filesystem::path& capture, const EncoderSettings& settings,
                 const HostSteps& steps = {});

  /// Plays the frames of the encoder's interface that had arrived by then into the stream.
  void play_until(std::int64_t arrival_ns, encoder::EncoderStream& stream,
                  Progress* progress = nullptr);
  void play(encoder::EncoderStream& stream);

  /// Says on stderr what was refused, and why. Throws Failure when no signal was read.
  void report(const encoder::EncoderStream& stream) const;
  /// From the first frame of the encoder's interface to the last that was played.
  TimeSpan span() const { return span_; }
  /// One sentence on why no frame was accepted.
  std::string why_nothing(const encoder::EncoderStream& stream) const;

private:
  std::string like_it(const encoder::EncoderCounters& counters) const;
  std::string name_;
  CanLogReader log_;
  SteadyTime steady_;
  EncoderSettings settings_;
  std::map<std::string, std::uint64_t> frames_;  // by interface
  TimeSpan span_;
  CanFrame next_;
  std::string interface_;  // of the next one
  bool has_next_ = false;
};

}  // namespace scree::cli
