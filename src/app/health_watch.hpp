#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <scree/health_t.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "keep_up.hpp"
#include "log_lines.hpp"
#include "scree/app/detection_report.hpp"
#include "scree/config/settings.hpp"
#include "scree/core/nanoseconds.hpp"
#include "sensor_status.hpp"
#include "sensor_watch.hpp"

namespace scree {

/// What became of the sweeps that were handed to the detector. Times are of the steady clock, 0
/// before the first.
struct DetectorStatus {
  std::int64_t last_loop_ns = 0;  ///< its thread waited, or began or ended with a sweep
  std::int64_t last_list_ns = 0;  ///< the data of the newest list that LCM took
  std::uint64_t not_covered = 0;  ///< sweeps that waited in vain for samples of IMU or encoder
  std::uint64_t slips = 0, heading_resets = 0;  ///< see MotionReport
  std::uint64_t not_sent = 0;                   ///< messages that LCM did not take in time
  SetupReport setup{};                          ///< see DetectionReport
  DropCounts drops{};                           ///< the same
};

/// Decides from what the threads report whether the robot sees, and what a person should read in
/// the log. It reads no clock: `now_ns` is the steady clock's.
///
/// The robot is blind unless packets of the lidar come and are understood (SensorWatch::kSilence)
/// and have returns (kReturnsStop), they make whole turns (kTurnStops), the detector is not late
/// (kDetectorStops) and lists of fresh data go out (kOldData). It is blind too where a setting is
/// so wrong that the lists cannot be right; they go out all the same, for whoever looks for the
/// mistake. Whatever stops is said within 300 ms when this is asked every 20 ms. Without IMU and
/// encoder the robot sees less well, and is not blind.
class HealthWatch {
public:
  /// The reason of the last message of all.
  static constexpr std::string_view kWasStopped = "screed was stopped";

  // A VLP-16 turns at least 5 times a second (its manual, rotation speed: 300 to 1200 rpm), so that
  // a turn takes 200 ms. Ground returns come in each turn; whole turns and the detector have 50 ms
  // more for what delays them.
  static constexpr std::int64_t kReturnsStop = 200 * kMillisecond;
  static constexpr std::int64_t kTurnStops = 250 * kMillisecond;
  static constexpr std::int64_t kDetectorStops = 250 * kMillisecond;
  // Two turns, and what it takes to make a list of one. Older data says nothing of now: it comes
  // after a pause of the process or of the whole computer, or LCM does not take lists.
  static constexpr std::int64_t kOldData = 500 * kMillisecond;

  HealthWatch(const Settings& settings, std::int64_t now_ns);

  /// Brings `health` up to date: its state and reason, and what concerns the sensors. True when one
  /// of these changed: the reason, what is wrong with the settings, the state of a sensor, of its
  /// clock or of the encoder's bus.
  bool update(std::int64_t now_ns, const LidarStatus& lidar, const ImuStatus& imu,
              const EncoderStatus& encoder, const DetectorStatus& detector, health_t& health);
  /// What the last update found worth a line in the log.
  const LogLines& log() const { return log_; }

private:
  void name_senders(const LidarStatus& lidar);
  SensorStatus status_of(const LidarStatus& lidar, std::int64_t now_ns) const;
  SensorStatus status_of(const ImuStatus& imu) const;
  SensorStatus status_of(const EncoderStatus& encoder) const;
  bool update_sensors(std::int64_t now_ns, const LidarStatus& lidar, const ImuStatus& imu,
                      const EncoderStatus& encoder, health_t& health);
  std::string blind_reason(std::int64_t now_ns, const LidarStatus& lidar, std::int8_t state,
                           const DetectorStatus& detector) const;
  void add_line(bool is_warning, std::string text) {
    log_.push_back({is_warning, std::move(text)});
  }
  bool update_setup(std::int64_t now_ns, const LidarStatus& lidar, const SetupReport& setup,
                    health_t& health);
  void log_sight(std::int64_t now_ns, const std::string& reason);
  void log_first_packets(const LidarStatus& lidar);
  void log_pulses(const LidarStatus& lidar);
  void log_losses(std::int64_t now_ns, const LidarStatus& lidar, const DetectorStatus& detector);

  Settings settings_;
  std::string port_;  // "UDP port 2368"
  std::optional<std::array<std::uint32_t, 3>> senders_;
  std::string sender_, foreign_;  // in words: of these the first; the other two
  LogLines log_;
  SensorWatch lidar_, imu_, encoder_;
  velodyne::Firmware logged_firmware_ = velodyne::Firmware::undecided;
  KeepUp keep_up_;
  std::uint32_t named_faults_ = 0;  // a bit for each slot of a SetupReport
  bool logs_sight_ = true;
  std::string logged_reason_;
  std::int64_t logged_at_ns_ = 0;
  bool logged_datagram_ = false, logged_packet_ = false;
  bool logged_pulse_ = false, logged_pps_lost_ = false, logged_no_pulse_ = false;
  static constexpr std::size_t kLosses = 8;
  std::array<GrowthLog, kLosses> losses_;
};

}  // namespace scree
