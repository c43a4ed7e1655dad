#include "health_watch.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>

#include "scree/core/ipv4.hpp"

namespace scree {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kGrowthPause = 10 * kSecond;
constexpr const char* kAdvice =
    "check the sensor's power and cable, the destination address on its web page, and the firewall";

/// The modes in which packets came, for the log.
std::string modes_of(const velodyne::LidarCounters& counters) {
  constexpr std::array kModes = {"strongest return", "last return", "dual return"};
  std::string modes;
  for (std::size_t i = 0; i < kModes.size(); ++i) {
    if (counters.by_mode[i] != 0) modes += (modes.empty() ? "" : ", ") + std::string(kModes[i]);
  }
  return modes;
}

/// Why most datagrams were refused.
std::string_view main_reason(const velodyne::LidarCounters& counters) {
  const auto most = std::max_element(counters.refused.begin(), counters.refused.end());
  return velodyne::kRefusalReasons[static_cast<std::size_t>(most - counters.refused.begin())];
}

std::int64_t signed_count(std::uint64_t count) {
  return static_cast<std::int64_t>(count);
}

void fill(const LidarStatus& lidar, lidar_health_t& health) {
  health.sender = lidar.sender == 0 ? "" : ipv4_text(lidar.sender);
  health.packets = signed_count(lidar.lidar.accepted);
  health.position_packets = signed_count(lidar.position_packets);
  health.lost_packets = signed_count(lidar.lidar.lost);
  health.kernel_drops = signed_count(lidar.data_port.kernel_drops);
  health.refused_reason.clear();
  health.refused.clear();
  const auto add = [&](std::string_view reason, std::uint64_t count) {
    health.refused_reason.emplace_back(reason);
    health.refused.push_back(signed_count(count));
  };
  for (std::size_t i = 1; i < velodyne::kRefusals; ++i) {
    add(velodyne::kRefusalNames[i], lidar.lidar.refused[i]);
  }
  add("sender", lidar.data_port.foreign);
  health.reasons = static_cast<std::int32_t>(health.refused.size());
}

}  // namespace

HealthWatch::HealthWatch(const LidarSettings& settings, std::int64_t now_ns)
    : settings_(settings),
      port_(fmt::format("UDP port {}", settings.port)),
      start_ns_(now_ns),
      silent_since_(now_ns) {}

bool HealthWatch::update(std::int64_t now_ns, const LidarStatus& lidar, std::int64_t last_list_ns,
                         health_t& health) {
  log_.clear();
  const std::int8_t old_lidar = health.lidar.state, old_state = health.state;
  fill(lidar, health.lidar);
  health.lidar.state = lidar_state(now_ns, lidar);
  const bool has_lists = last_list_ns != 0 && now_ns - last_list_ns <= kListsStop;
  const bool sees = health.lidar.state == lidar_health_t::OK && has_lists;
  health.state = sees ? health_t::OK : health_t::BLIND;
  health.reason = sees ? "" : blind_reason(lidar, health.lidar.state);

  say_first_packets(lidar);
  say_silence(now_ns, lidar);
  say_pulses(lidar);
  if (health.state != old_state)
    say(!sees, sees ? "sees: obstacle lists go out" : "blind: " + health.reason);
  for (std::size_t i = 1; i < velodyne::kRefusals; ++i) {
    say_growth(now_ns, refused_[i], lidar.lidar.refused[i],
               fmt::format("datagrams on {} refused: {}", port_, velodyne::kRefusalReasons[i]));
  }
  say_growth(now_ns, foreign_, lidar.data_port.foreign,
             fmt::format("datagrams on {} refused: not from {}", port_, settings_.sender));
  say_growth(now_ns, kernel_drops_, lidar.data_port.kernel_drops,
             fmt::format("datagrams on {} dropped by the kernel: the reader was too slow", port_));
  say_growth(now_ns, sweeps_dropped_, lidar.sweeps_dropped,
             "sweeps dropped: the detector was too slow");
  return health.state != old_state || health.lidar.state != old_lidar;
}

std::int8_t HealthWatch::lidar_state(std::int64_t now_ns, const LidarStatus& lidar) const {
  if (lidar.last_datagram_ns == 0) return lidar_health_t::NEVER_SEEN;
  if (now_ns - lidar.last_datagram_ns > kSilence) return lidar_health_t::SILENT;
  const bool is_understood = lidar.last_packet_ns != 0 && now_ns - lidar.last_packet_ns <= kSilence;
  return is_understood ? lidar_health_t::OK : lidar_health_t::WRONG_DATA;
}

std::string HealthWatch::blind_reason(const LidarStatus& lidar, std::int8_t state) const {
  switch (state) {
    case lidar_health_t::NEVER_SEEN:
      return lidar.data_port.foreign == 0
                 ? fmt::format("nothing has come on {}", port_)
                 : fmt::format("datagrams on {} come from others than {}", port_, settings_.sender);
    case lidar_health_t::SILENT:
      return fmt::format("no packets on {}", port_);
    case lidar_health_t::WRONG_DATA:
      return fmt::format("datagrams on {} are not packets of a {}: {}", port_,
                         name_of(settings_.model), main_reason(lidar.lidar));
    default:
      break;
  }
  if (lidar.is_last_sweep_empty) return "the lidar's last turn has no return: is it covered?";
  if (lidar.lidar.sweeps == 0) return "the lidar has not made a whole turn yet";
  return "packets come, but no sweep has got through the detector";
}

void HealthWatch::say_first_packets(const LidarStatus& lidar) {
  if (!said_datagram_ && lidar.last_datagram_ns != 0) {
    say(false, fmt::format("first datagram on {} is from {} and has {} bytes", port_,
                           ipv4_text(lidar.sender), lidar.datagram_size));
    said_datagram_ = true;
  }
  if (!said_packet_ && lidar.last_packet_ns != 0) {
    say(false, fmt::format("packets are understood: {}, {}", name_of(settings_.model),
                           modes_of(lidar.lidar)));
    said_packet_ = true;
  }
  if (lidar.firmware != said_firmware_) {
    say(lidar.firmware == velodyne::Firmware::foreign, std::string(sentence(lidar.firmware)));
    said_firmware_ = lidar.firmware;
  }
}

void HealthWatch::say_pulses(const LidarStatus& lidar) {
  if (!said_pulse_ && lidar.pulses > 0) {
    say(false, "the pulse per second of gpio.pps comes");
    said_pulse_ = true;
  }
  if (!said_pps_lost_ && lidar.is_pps_lost) {
    say(true, "the GPIO chip of gpio.pps is gone: plug it in again and restart screed");
    said_pps_lost_ = true;
  }
}

void HealthWatch::say_silence(std::int64_t now_ns, const LidarStatus& lidar) {
  const std::int64_t last = lidar.last_datagram_ns == 0 ? start_ns_ : lidar.last_datagram_ns;
  if (!said_silence_ && now_ns - last >= kSecond) {
    say(true, fmt::format("{} on {} for 1 s: {}",
                          lidar.last_datagram_ns == 0 ? "nothing has come" : "no packets", port_,
                          kAdvice));
    said_silence_ = true;
    silent_since_ = last;
  } else if (said_silence_ && now_ns - last < kSilence) {
    if (silent_since_ != start_ns_) {  // else they are the first, which is said already
      say(false, fmt::format("packets on {} again after {:.1f} s", port_,
                             static_cast<double>(last - silent_since_) / kSecond));
    }
    said_silence_ = false;
  }
}

void HealthWatch::say_growth(std::int64_t now_ns, Growth& growth, std::uint64_t count,
                             const std::string& what) {
  if (count == growth.said || (growth.said != 0 && now_ns - growth.said_at < kGrowthPause)) return;
  say(true, fmt::format("{} ({} more, {} since the start)", what, count - growth.said, count));
  growth = {count, now_ns};
}

}  // namespace scree
