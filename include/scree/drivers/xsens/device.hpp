#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "scree/config/settings.hpp"
#include "scree/core/result.hpp"
#include "scree/drivers/xsens/serial_port.hpp"
#include "scree/drivers/xsens/start_up.hpp"

namespace scree::xsens {

enum class DeviceState : std::uint8_t {
  lost,      ///< no port, or no MTi that could be started; tried again for ever
  starting,  ///< see StartUp
  measuring  ///< what comes is handed out
};

/// Since the device was made.
struct DeviceCounts {
  std::uint64_t bytes = 0;     ///< handed out
  std::uint64_t starts = 0;    ///< times that it began to measure
  std::uint64_t losses = 0;    ///< times that the port went away
  std::uint64_t silences = 0;  ///< times that no data came and it was started anew
};

/// An MTi on a serial port, kept measuring: opened, started, and after an unplugging, a refusal or
/// two seconds without data started anew, for ever.
///
/// Never blocks. Wait until the descriptor is readable or the time is due, then call advance()
/// until it gives nothing.
class Device {
public:
  /// One sentence when the port cannot be opened now, or its line is too slow for the outputs.
  static Result<Device> open(const ImuSettings& settings);

  /// Does what is due, and gives what one read brought while it measures. The bytes lie in the
  /// device's memory until the next call.
  /// @param now_ns of a clock that is never set
  std::optional<ReceivedBytes> advance(std::int64_t now_ns);

  /// -1 while there is no port.
  int descriptor() const { return port_ ? port_->descriptor() : -1; }
  /// When advance() has to be called at the latest.
  std::int64_t due_ns() const;

  DeviceState state() const { return state_; }
  /// What keeps it from measuring, or did last, one sentence; empty before.
  const std::string& problem() const { return problem_; }
  /// What the device does otherwise than configured, one sentence; mostly empty.
  const std::string& note() const { return start_up_.note(); }
  /// 0 until it is known.
  std::uint64_t device_id() const { return start_up_.device_id(); }
  const DeviceCounts& counts() const { return counts_; }

private:
  explicit Device(const ImuSettings& settings);

  void reopen(std::int64_t now_ns);
  void start(std::int64_t now_ns);
  void go_on_starting(std::int64_t now_ns);
  void serve_start_up(std::int64_t now_ns);
  void lose_port(std::int64_t now_ns);
  void lose(std::string problem, std::int64_t retry_ns);

  ImuSettings settings_;
  std::optional<SerialPort> port_;
  StartUp start_up_;
  DeviceState state_ = DeviceState::lost;
  int line_baud_ = 0;
  std::int64_t retry_ns_ = 0;      ///< when to open the port again
  Framer framer_;                  ///< of what is handed out
  std::int64_t last_data_ns_ = 0;  ///< an MTData2 message, while measuring
  std::string problem_;
  DeviceCounts counts_;
  std::array<std::uint8_t, 4096> buffer_{};
};

}  // namespace scree::xsens
