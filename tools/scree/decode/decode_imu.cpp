#include "decode/csv_file.hpp"
#include "decode/decode.hpp"
#include "read/imu_capture.hpp"
#include "read/lidar_capture.hpp"

namespace scree::cli {
namespace {

template <class T>
void write(CsvFile& csv, const std::optional<T>& value) {
  if (value) {
    csv.value(*value);
  } else {
    csv.nothing();
  }
}

/// A real number as it was sent: a float has a float's digits.
template <std::size_t N>
void write(CsvFile& csv, const std::optional<xsens::Numbers<N>>& numbers) {
  for (std::size_t i = 0; i < N; ++i) {
    if (!numbers) {
      csv.nothing();
    } else if (numbers->format == xsens::Format::float32) {
      csv.value(static_cast<float>((*numbers)[i]));
    } else {
      csv.value((*numbers)[i]);
    }
  }
}

void write_measurement(CsvFile& csv, std::int64_t t_ns, const xsens::Measurement& measurement) {
  const auto& rate =
      measurement.rate_of_turn ? measurement.rate_of_turn : measurement.rate_of_turn_hr;
  const auto& acceleration =
      measurement.acceleration ? measurement.acceleration : measurement.acceleration_hr;
  csv.value(t_ns);
  write(csv, measurement.packet_counter);
  write(csv, measurement.sample_time_fine);
  write(csv, measurement.quaternion);
  write(csv, measurement.euler_angles);
  write(csv, rate);
  write(csv, acceleration);
  if (measurement.status_word) {
    csv.value(*measurement.status_word);
  } else {
    write(csv, measurement.status_byte);
  }
  csv.end_line();
}

}  // namespace

void decode_imu(const DecodeOptions& options) {
  const Settings settings = capture_settings(options.capture, options.config);
  const HostSteps steps = find_host_steps(options.capture, settings.lidar);
  ImuCapture capture(options.capture, steps);
  CsvFile csv(options.out);
  csv.line(
      "t_ns,packet_counter,sample_time_fine,qw,qx,qy,qz,roll_deg,pitch_deg,yaw_deg,"
      "wx,wy,wz,ax,ay,az,status");
  xsens::ImuStream stream(settings.imu, {},
                          [&](std::int64_t t_ns, const xsens::Measurement& measurement) {
                            write_measurement(csv, t_ns, measurement);
                          });
  capture.play(stream);
  report_capture(capture, stream);
  csv.close();
  say(steps);
}

}  // namespace scree::cli
