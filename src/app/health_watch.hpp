#pragma once

#include <array>
#include <scree/health_t.hpp>
#include <string>
#include <vector>

#include "lidar_status.hpp"
#include "scree/config/settings.hpp"

namespace scree {

/// Judges from what the threads report whether the robot sees, and what a person should read in the
/// log. Knows no clock: `now_ns` is the steady clock's. It may take states as follows.
///
/// | lidar state | when                                                                   |
/// |-------------|------------------------------------------------------------------------|
/// | NEVER_SEEN  | no datagram since the start                                            |
/// | SILENT      | no datagram for kSilence                                               |
/// | WRONG_DATA  | datagrams, and none of them accepted for kSilence                      |
/// | OK          | else; the robot is blind all the same when no list came for kListsStop |
class HealthWatch {
public:
  // The daemon looks every 50 ms, so that blindness is published within 300 ms. A VLP-16 sends a
  // packet every 1.3 ms and turns at least 5 times a second.
  static constexpr std::int64_t kSilence = 200'000'000;
  static constexpr std::int64_t kListsStop = 500'000'000;

  struct Line {
    bool is_warning;
    std::string text;
  };

  HealthWatch(const LidarSettings& settings, std::int64_t now_ns);

  /// Brings `health` up to date: its state and reason, and what concerns the lidar but for the
  /// packet rate. True when the state of the robot or of the lidar changed.
  bool update(std::int64_t now_ns, const LidarStatus& lidar, std::int64_t last_list_ns,
              health_t& health);
  /// What the last update found worth a line in the log.
  const std::vector<Line>& log() const { return log_; }

private:
  /// A count that is reported when it has grown, but not more often than every ten seconds.
  struct Growth {
    std::uint64_t said = 0;
    std::int64_t said_at = 0;
  };

  std::int8_t lidar_state(std::int64_t now_ns, const LidarStatus& lidar) const;
  std::string blind_reason(const LidarStatus& lidar, std::int8_t state) const;
  void say(bool is_warning, std::string text) { log_.push_back({is_warning, std::move(text)}); }
  void say_first_packets(const LidarStatus& lidar);
  void say_pulses(const LidarStatus& lidar);
  void say_silence(std::int64_t now_ns, const LidarStatus& lidar);
  void say_growth(std::int64_t now_ns, Growth& growth, std::uint64_t count,
                  const std::string& what);

  LidarSettings settings_;
  std::string port_;  // "UDP port 2368"
  std::int64_t start_ns_;
  std::vector<Line> log_;
  velodyne::Firmware said_firmware_ = velodyne::Firmware::undecided;
  bool said_datagram_ = false, said_packet_ = false, said_silence_ = false;
  bool said_pulse_ = false, said_pps_lost_ = false;
  std::int64_t silent_since_ = 0;
  std::array<Growth, velodyne::kRefusals> refused_;
  Growth foreign_, kernel_drops_, sweeps_dropped_;
};

}  // namespace scree
