#include "read/motion_capture.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdio>

#include "commands.hpp"
#include "scree/capture/capture.hpp"

namespace scree::cli {
namespace {

void note(const std::string& text) {
  if (text.empty()) return;
  fmt::print(stderr, "scree: {}\n", text);
}

/// In one thread nothing has to wait in a ring, which a long part without lidar would overflow.
template <class Sample>
void put(SyncBuffer& sensors, const Sample& sample) {
  sensors.put(sample);
  sensors.gather();
}

}  // namespace

std::string note_of_other_clock(const char* what, const TimeSpan& sensor, const TimeSpan& lidar) {
  constexpr std::int64_t kShift = 500'000'000;
  if (sensor.empty() || lidar.empty()) return "";
  const std::int64_t late_ns = sensor.first_ns - lidar.first_ns;
  const std::int64_t early_ns = lidar.last_ns - sensor.last_ns;
  if (sensor.meets(lidar)) {
    if (late_ns <= kShift && early_ns <= kShift) return "";
    return fmt::format(
        "the {} begin {:+.1f} s and end {:+.1f} s against the lidar's packets: if they were logged "
        "together, their clocks differ (candump -L)",
        what, static_cast<double>(late_ns) * 1e-9, static_cast<double>(-early_ns) * 1e-9);
  }
  return fmt::format(
      "the {} lie outside the lidar's time ({} against {}): not used; log both by the same clock "
      "(candump -L)",
      what, sensor.text(), lidar.text());
}

MotionCapture::MotionCapture(const std::filesystem::path& capture,
                             const std::filesystem::path& config, const Settings& settings,
                             SyncBuffer& sensors, const HostSteps& steps)
    : encoder_settings_(encoder_settings(capture, config)),
      imu_stream_(settings.imu, [&sensors](const ImuSample& sample) { put(sensors, sample); }),
      encoder_stream_(encoder_settings_,
                      [&sensors](const EncoderSample& sample) { put(sensors, sample); }) {
  if (!std::filesystem::is_directory(capture)) return;
  // A recording that was cut short leaves empty files.
  const auto imu = imu_file(capture), can = can_file(capture);
  const bool has_imu = !settings.imu.device.empty();
  const bool has_encoder = !settings.encoder.interface.empty();
  if (has_imu && imu && std::filesystem::file_size(*imu) > 0) imu_.emplace(capture, steps);
  if (has_encoder && can) encoder_.emplace(capture, encoder_settings_, steps);
  no_imu_ = !has_imu ? "imu.device is empty: no IMU is used"
            : imu    ? imu->string() + ": the file is empty"
                     : imu.error().message;
  if (!has_encoder) {
    no_encoder_ = "encoder.interface is empty: no encoder is used";
  } else if (!can) {
    no_encoder_ = can.error().message;
  }
  if (!imu && !can) no_motion_ = other_files(capture);
}

void MotionCapture::play_until(std::int64_t arrival_ns) {
  if (imu_) imu_->play_until(arrival_ns, imu_stream_);
  if (encoder_) encoder_->play_until(arrival_ns, encoder_stream_);
}

void MotionCapture::finish() {
  if (imu_) imu_->play(imu_stream_);
  if (encoder_) encoder_->play(encoder_stream_);
}

void MotionCapture::report(const TimeSpan& lidar) const {
  if (!imu_ && !encoder_) {
    note("neither IMU nor encoder in the capture: the lidar alone told how the robot moves" +
         no_motion_);
    return;
  }
  if (!imu_) {
    note(no_imu_);
  } else if (imu_stream_.counters().accepted == 0) {
    note(imu_->why_nothing(imu_stream_));
  } else {
    report_capture(*imu_, imu_stream_);
    note(note_of_other_clock("IMU's bytes", imu_->span(), lidar));
    if (imu_stream_.counters().useful == 0) {
      note("the IMU sent neither orientation nor rate of turn: it is not used");
    } else if (imu_stream_.counters().oriented == 0) {
      note("the IMU sent no orientation: it was made of its rates and accelerations");
    }
  }
  if (!encoder_) {
    note(no_encoder_);
  } else if (encoder_stream_.counters().accepted == 0) {
    note(encoder_->why_nothing(encoder_stream_));
  } else {
    encoder_->report(encoder_stream_);
    note(note_of_other_clock("encoder's frames", encoder_->span(), lidar));
  }
}

}  // namespace scree::cli
