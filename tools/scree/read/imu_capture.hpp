#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/progress.hpp"
#include "common/time_span.hpp"
#include "read/host_steps.hpp"
#include "scree/capture/pcap_reader.hpp"
#include "scree/drivers/xsens/imu_stream.hpp"

namespace scree::cli {

/// The IMU's file of a capture. Throws Failure, also where it holds no serial bytes.
PcapReader open_imu(const std::filesystem::path& capture);

/// The IMU's part of a capture, and what was seen of it while it was played.
class ImuCapture {
public:
  /// @param steps taken out of all times
  /// Throws Failure.
  explicit ImuCapture(const std::filesystem::path& capture, const HostSteps& steps = {});

  /// Plays what had arrived by then into the stream.
  void play_until(std::int64_t arrival_ns, xsens::ImuStream& stream, Progress* progress = nullptr);
  /// Plays the whole file into the stream, as the daemon would read it from the port, and flushes
  /// the stream.
  void play(xsens::ImuStream& stream);

  std::uint64_t bytes() const { return bytes_; }
  /// From the first read to the last.
  double seconds() const;
  TimeSpan span() const { return reads_ > 0 ? TimeSpan{first_ns_, last_ns_} : TimeSpan(); }
  /// Why the file ended before its end; empty if it did not.
  const std::string& broken_off() const { return reader_.broken_off(); }

  /// One sentence on why no message was accepted.
  std::string why_nothing(const xsens::ImuStream& stream) const;

private:
  std::string name_;
  PcapReader reader_;
  SteadyTime steady_;
  PcapRecord next_;
  bool has_next_ = false;
  std::uint64_t reads_ = 0, bytes_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
};

/// The end of decoding: what a person should know goes to stderr; throws Failure when no message
/// was accepted.
void report_capture(const ImuCapture& capture, const xsens::ImuStream& stream);

}  // namespace scree::cli
