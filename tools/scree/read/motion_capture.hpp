#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "read/encoder_capture.hpp"
#include "read/imu_capture.hpp"
#include "scree/sync/sync_buffer.hpp"

namespace scree::cli {

/// What to say of a sensor whose samples lie outside the lidar's time: they never meet a sweep, and
/// otherwise nobody would know. Empty where they do not, or where one of both says nothing.
/// @param what "encoder's frames"
std::string note_of_other_clock(const char* what, const TimeSpan& sensor, const TimeSpan& lidar);

/// The IMU's and the encoder's part of a capture, played into the pipeline as time goes on. A
/// capture may lack either.
class MotionCapture {
public:
  /// Keeps a reference to the buffer. Throws Failure.
  /// @param steps taken out of all times
  MotionCapture(const std::filesystem::path& capture, const std::filesystem::path& config,
                const Settings& settings, SyncBuffer& sensors, const HostSteps& steps = {});

  /// Plays what had arrived by then.
  void play_until(std::int64_t arrival_ns);
  void finish();
  /// Says on stderr what a person should know: what was refused, a sensor that said nothing or only
  /// at other times than the lidar's.
  void report(const TimeSpan& lidar) const;

  bool has_imu() const { return imu_.has_value(); }
  bool has_encoder() const { return encoder_.has_value(); }
  const xsens::ImuCounters& imu() const { return imu_stream_.counters(); }
  const encoder::EncoderCounters& encoder() const { return encoder_stream_.counters(); }

private:
  EncoderSettings encoder_settings_;  // with what their DBC file says
  std::optional<ImuCapture> imu_;
  std::optional<EncoderCapture> encoder_;
  xsens::ImuStream imu_stream_;
  encoder::EncoderStream encoder_stream_;
  std::string no_imu_, no_encoder_, no_motion_;  // why there is none
};

}  // namespace scree::cli
