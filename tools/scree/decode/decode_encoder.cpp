#include "decode/csv_file.hpp"
#include "decode/decode.hpp"
#include "read/encoder_capture.hpp"

namespace scree::cli {

void decode_encoder(const DecodeOptions& options) {
  const EncoderSettings settings = encoder_settings(options.capture, options.config);
  EncoderCapture capture(options.capture, settings);
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
}

}  // namespace scree::cli
