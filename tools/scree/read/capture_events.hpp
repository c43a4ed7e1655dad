#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "read/host_steps.hpp"
#include "read/lidar_file.hpp"
#include "scree/capture/can_log.hpp"
#include "scree/capture/pcap_reader.hpp"
#include "scree/config/settings.hpp"

namespace scree::cli {

enum class Sensor : std::uint8_t { lidar, imu, encoder };
inline constexpr std::size_t kSensors = 3;

/// What came from a sensor at one moment. The bytes lie in the reader's memory until the next read.
struct CaptureEvent {
  Sensor sensor = Sensor::lidar;
  std::int64_t arrival_ns = 0;
  std::span<const std::uint8_t> bytes;  ///< of a datagram, or of a read from the IMU's port
  int port = 0;                         ///< that the datagram went to
  CanFrame frame;
};

/// What a capture holds of all its sensors, in the order of arrival, with the times as they would
/// be had nobody set the host's clock meanwhile. It may lack sensors; of a CAN log it has the
/// frames of the encoder's interface.
class CaptureEvents {
public:
  /// Throws Failure, also where there is nothing at all.
  CaptureEvents(const std::filesystem::path& capture, const Settings& settings);

  /// False at the end.
  bool next(CaptureEvent& event);

  bool has_imu() const { return imu_.has_value(); }
  bool has_encoder() const { return can_.has_value(); }
  /// Why a file ended before its end; empty if none did.
  std::string broken_off() const;

private:
  std::optional<CaptureEvent> read(Sensor sensor);
  std::optional<CaptureEvent> read_as_recorded(Sensor sensor);

  std::optional<LidarFile> lidar_;
  std::optional<PcapReader> imu_;
  std::optional<CanLogReader> can_;
  std::string interface_;
  std::array<SteadyTime, kSensors> steady_;
  std::array<std::optional<CaptureEvent>, kSensors> waiting_;  // of each sensor, its next one
  std::optional<Sensor> handed_out_;
};

/// The first arrival in a capture and the last one, nanoseconds: reads all of it.
std::pair<std::int64_t, std::int64_t> span_of(const std::filesystem::path& capture,
                                              const Settings& settings);

}  // namespace scree::cli
