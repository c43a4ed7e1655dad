#include "decode/csv_file.hpp"
#include "decode/decode.hpp"
#include "read/encoder_capture.hpp"
#include "read/lidar_capture.hpp"

namespace scree::cli {

void decode_encoder(const DecodeOptions& options) {
  const EncoderSettings settings = encoder_settings(options.capture, options.config);
  const LidarSettings lidar = capture_settings(options.capture, options.config).lidar;
  const HostSteps steps = find_host_steps(options.capture, lidar);
  EncoderCapture capture(options.capture, settings, steps);
  CsvFile csv(options.out);
  csv.line("t_ns,raw,value");
  const auto on_reading = [&](const encoder::Reading& reading) {
    csv.value(reading.t_ns);
    if (settings.is_signed) {
      csv.value(reading.raw);
    } else {
      csv.value(static_cast<std::uint64_t>(reading.raw));
    }
    csv.value(reading.value);
    csv.end_line();
  };
  encoder::EncoderStream stream(settings, {}, on_reading);
  capture.play(stream);
  csv.close();
  capture.report(stream);
  say(steps);
}

}  // namespace scree::cli
