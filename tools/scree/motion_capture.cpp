#include "motion_capture.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdio>

#include "commands.hpp"
#include "scree/capture/capture.hpp"

namespace scree::cli {
namespace {

void note(const std::string& text) {
  fmt::print(stderr, "scree: {}\n", text);
}

}  // namespace

MotionCapture::MotionCapture(const std::filesystem::path& capture,
                             const std::filesystem::path& config, const Settings& settings,
                             SyncBuffer& sensors)
    : encoder_settings_(encoder_settings(capture, config)),
      imu_stream_(settings.imu, [&sensors](const ImuSample& sample) { sensors.put(sample); }),
      encoder_stream_(encoder_settings_,
                      [&sensors](const EncoderSample& sample) { sensors.put(sample); }) {
  if (!std::filesystem::is_directory(capture)) return;
  if (imu_file(capture)) imu_.emplace(capture);
  if (can_file(capture)) encoder_.emplace(capture, encoder_settings_);
}

void MotionCapture::play_until(std::int64_t arrival_ns) {
  if (imu_) imu_->play_until(arrival_ns, imu_stream_);
  if (encoder_) encoder_->play_until(arrival_ns, encoder_stream_);
}

void MotionCapture::finish() {
  if (imu_) imu_->play(imu_stream_);
  if (encoder_) encoder_->play(encoder_stream_);
}

void MotionCapture::report() const {
  if (!imu_ && !encoder_) {
    note("neither IMU nor encoder in the capture: each sweep was taken by itself");
    return;
  }
  if (imu_stream_.counters().samples == 0) {
    note("no sample of the IMU");
  } else {
    report_capture(*imu_, imu_stream_);
  }
  if (encoder_stream_.counters().accepted == 0) {
    note("no sample of the encoder");
  } else {
    encoder_->report(encoder_stream_);
  }
}

}  // namespace scree::cli
