#pragma once

#include <scree/health_t.hpp>
#include <string>
#include <utility>

#include "log_lines.hpp"
#include "scree/config/settings.hpp"
#include "sensor_status.hpp"
#include "sensor_watch.hpp"

namespace scree {

/// Judges from what the threads report whether the robot sees, and what a person should read in the
/// log. Knows no clock: `now_ns` is the steady clock's. The robot is blind unless packets of the
/// lidar come and are understood and a list came within kListsStop; without IMU and encoder it sees
/// less well, and is not blind.
class HealthWatch {
public:
  // A VLP-16 turns at least 5 times a second.
  static constexpr std::int64_t kListsStop = 500'000'000;

  HealthWatch(const Settings& settings, std::int64_t now_ns);

  /// Brings `health` up to date: its state and reason, and what concerns the sensors. True when the
  /// state of the robot, of a sensor or of the encoder's bus changed.
  bool update(std::int64_t now_ns, const LidarStatus& lidar, const ImuStatus& imu,
              const EncoderStatus& encoder, std::int64_t last_list_ns, health_t& health);
  /// What the last update found worth a line in the log.
  const LogLines& log() const { return log_; }

private:
  SensorStatus status_of(const LidarStatus& lidar) const;
  SensorStatus status_of(const ImuStatus& imu) const;
  SensorStatus status_of(const EncoderStatus& encoder) const;
  bool update_sensors(std::int64_t now_ns, const LidarStatus& lidar, const ImuStatus& imu,
                      const EncoderStatus& encoder, health_t& health);
  std::string blind_reason(const LidarStatus& lidar, std::int8_t state) const;
  void say(bool is_warning, std::string text) { log_.push_back({is_warning, std::move(text)}); }
  void say_first_packets(const LidarStatus& lidar);
  void say_pulses(const LidarStatus& lidar);

  Settings settings_;
  std::string port_;  // "UDP port 2368"
  LogLines log_;
  SensorWatch lidar_, imu_, encoder_;
  velodyne::Firmware said_firmware_ = velodyne::Firmware::undecided;
  bool said_datagram_ = false, said_packet_ = false;
  bool said_pulse_ = false, said_pps_lost_ = false;
  Growth sweeps_dropped_;
};

}  // namespace scree
