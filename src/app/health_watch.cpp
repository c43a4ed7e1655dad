#include "health_watch.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <tuple>

#include "scree/core/ipv4.hpp"
#include "scree/drivers/velodyne/position_packet.hpp"
#include "scree/sync/sync_buffer.hpp"

namespace scree {
namespace {

/// The modes in which packets came, for the log.
std::string modes_of(const velodyne::LidarCounters& counters) {
  constexpr std::array kModes = {"strongest return", "last return", "dual return"};
  std::string modes;
  for (std::size_t i = 0; i < kModes.size(); ++i) {
    if (counters.by_mode[i] != 0) modes += (modes.empty() ? "" : ", ") + std::string(kModes[i]);
  }
  return modes;
}

/// Adds the counts of what a decoder has refused, without that of [none].
template <class Names, class Reasons, class Counts>
void add_refused(const Names& names, const Reasons& reasons, const Counts& counts,
                 SensorStatus& status) {
  constexpr std::size_t kOthers = 2;  // that a sensor adds
  static_assert(std::tuple_size_v<Names> + kOthers <= SensorStatus::kMostReasons + 1);
  for (std::size_t i = 1; i < names.size(); ++i) {
    status.refused.push_back({names[i], reasons[i], counts[i]});
  }
}

/// Whether position packets come, and came on when the data packets ended: a cable that is pulled
/// ends both.
bool sends_position_alone(const LidarStatus& lidar, std::int64_t now_ns) {
  constexpr std::int64_t kRecent = 500'000'000, kTogether = 50'000'000;
  return lidar.last_position_ns != 0 && now_ns - lidar.last_position_ns < kRecent &&
         lidar.last_position_ns - lidar.last_datagram_ns > kTogether;
}

/// Whether Scree has asked the IMU for messages without an orientation.
bool gives_high_rates(const ImuSettings& imu) {
  return imu.configure && (imu.acceleration_hr_rate > 0 || imu.gyro_hr_rate > 0);
}

}  // namespace

HealthWatch::HealthWatch(const Settings& settings, std::int64_t now_ns)
    : settings_(settings),
      port_(fmt::format("UDP port {}", settings.lidar.port)),
      lidar_({"packets on " + port_,
              "check the sensor's power and cable, the destination address on its web page, and "
              "the firewall"},
             now_ns),
      imu_({"messages from the IMU on " + settings.imu.device,
            "check its cable and power, imu.device and imu.baud",
            settings.imu.configure ? static_cast<double>(settings.imu.rate) : 0},
           now_ns),
      // Frames that are further apart say nothing of the motion between them.
      encoder_({"frames of the encoder on " + settings.encoder.interface,
                "check the encoder's power, the bus and its bit rate, and encoder.can_id",
                1e9 / static_cast<double>(SyncBuffer::kSilenceNs)},
               now_ns),
      keep_up_(settings.detect.lists_per_turn) {}

bool HealthWatch::update(std::int64_t now_ns, const LidarStatus& lidar, const ImuStatus& imu,
                         const EncoderStatus& encoder, const DetectorStatus& detector,
                         health_t& health) {
  log_.clear();
  const std::int8_t before = health.state;
  const std::string reason_before = health.reason;
  name_senders(lidar);
  log_first_packets(lidar);
  log_pulses(lidar);
  bool has_changed = update_sensors(now_ns, lidar, imu, encoder, health);
  has_changed = update_setup(now_ns, lidar, detector.setup, health) || has_changed;

  health.reason = blind_reason(now_ns, lidar, health.lidar.state, detector);
  const bool sees = health.reason.empty();
  health.state = sees ? health_t::OK : health_t::BLIND;
  if (health.state != before) log_sight(now_ns, health.reason);
  log_losses(now_ns, lidar, detector);
  return has_changed || health.reason != reason_before;
}

bool HealthWatch::update_sensors(std::int64_t now_ns, const LidarStatus& lidar,
                                 const ImuStatus& imu, const EncoderStatus& encoder,
                                 health_t& health) {
  bool has_changed = lidar_.update(now_ns, status_of(lidar, now_ns), health.lidar, log_);
  // Those that are switched off are not missed.
  if (!settings_.imu.device.empty()) {
    has_changed |= imu_.update(now_ns, status_of(imu), health.imu, log_);
  }
  if (!settings_.encoder.interface.empty()) {
    has_changed |= encoder_.update(now_ns, status_of(encoder), health.encoder, log_);
  }
  const std::string_view bus = encoder::kBusStateNames[static_cast<std::size_t>(encoder.bus)];
  has_changed |= health.encoder_bus != bus;
  health.encoder_bus = bus;
  health.position_packets = static_cast<std::int64_t>(lidar.position_packets);
  return has_changed;
}

/// Each mistake is logged when it is found, and again with other numbers only when it comes back.
/// @return whether there are others now
bool HealthWatch::update_setup(std::int64_t now_ns, const LidarStatus& lidar,
                               const SetupReport& setup, health_t& health) {
  std::uint32_t named = 0;
  setup.for_each_slot([&](std::size_t slot, const SetupFinding&) { named |= 1U << slot; });
  const bool was_slow = !keep_up_.sentence().empty();
  const bool is_other = keep_up_.update(now_ns, lidar.lidar.sweeps + lidar.lidar.parts,
                                        lidar.sweeps_dropped + lidar.parts_dropped);
  if (named == named_faults_ && !is_other) return false;
  health.setup.clear();
  setup.for_each_slot([&](std::size_t slot, const SetupFinding& finding) {
    health.setup.push_back(sentence(finding));
    if ((named_faults_ >> slot & 1U) == 0) add_line(true, health.setup.back());
  });
  if (!keep_up_.sentence().empty()) {
    health.setup.push_back(keep_up_.sentence());
    if (!was_slow) add_line(true, keep_up_.sentence());
  }
  health.setup_size = static_cast<std::int32_t>(health.setup.size());
  named_faults_ = named;
  return true;
}

/// Says anew from whom the lidar's packets come, where that has changed.
void HealthWatch::name_senders(const LidarStatus& lidar) {
  const std::array senders = {lidar.sender, lidar.senders.other(), lidar.senders.taken()};
  if (senders == senders_) return;
  senders_ = senders;
  sender_ = lidar.sender == 0 ? "" : ipv4_text(lidar.sender);
  foreign_ = !settings_.lidar.sender.empty()
                 ? "not from " + settings_.lidar.sender
                 : fmt::format(
                       "from {}, while those from {} are taken: two sensors send to this port, "
                       "choose one with lidar.sender",
                       ipv4_text(lidar.senders.other()), ipv4_text(lidar.senders.taken()));
}

SensorStatus HealthWatch::status_of(const LidarStatus& lidar, std::int64_t now_ns) const {
  SensorStatus status;
  status.source = sender_;
  if (sends_position_alone(lidar, now_ns)) status.advice = velodyne::kPositionAlone;
  status.last_heard_ns = lidar.last_datagram_ns;
  status.last_message_ns = lidar.last_packet_ns;
  status.messages = lidar.lidar.accepted;
  status.lost = lidar.lidar.lost;
  status.kernel_drops = lidar.data_port.kernel_drops;
  add_refused(velodyne::kRefusalNames, velodyne::kRefusalReasons, lidar.lidar.refused, status);
  status.refused.push_back(
      {"sender", foreign_, lidar.data_port.foreign + lidar.senders.left_out()});
  status.clock = lidar.clock;
  return status;
}

SensorStatus HealthWatch::status_of(const ImuStatus& imu) const {
  SensorStatus status;
  status.source = settings_.imu.device;
  status.last_heard_ns = imu.last_bytes_ns;
  status.last_message_ns = imu.last_message_ns;
  status.messages = imu.imu.useful;
  status.lost = imu.imu.lost;
  add_refused(xsens::kRefusalNames, xsens::kRefusalReasons, imu.imu.refused, status);
  if (!gives_high_rates(settings_.imu)) {
    status.refused.push_back({"no_orientation", "neither orientation nor rate of turn in them",
                              imu.imu.samples - imu.imu.useful});
  }
  status.refused.push_back(
      {"stray_bytes", "bytes that belong to no message", imu.imu.bytes_skipped});
  status.clock = imu.clock;
  return status;
}

SensorStatus HealthWatch::status_of(const EncoderStatus& encoder) const {
  SensorStatus status;
  status.source = settings_.encoder.interface;
  status.last_heard_ns = encoder.last_frame_ns;
  status.last_message_ns = encoder.last_sample_ns;
  status.messages = encoder.encoder.accepted;
  status.kernel_drops = encoder.socket.kernel_drops;
  add_refused(encoder::kRefusalNames, encoder::kRefusalReasons, encoder.encoder.refused, status);
  status.refused.push_back({"malformed", "no frames of the kernel", encoder.socket.malformed});
  return status;
}

/// Why the robot is blind; empty when it sees.
std::string HealthWatch::blind_reason(std::int64_t now_ns, const LidarStatus& lidar,
                                      std::int8_t state, const DetectorStatus& detector) const {
  const std::string_view position =
      sends_position_alone(lidar, now_ns) ? ", but position packets come" : "";
  switch (state) {
    case sensor_health_t::NEVER_SEEN:
      return lidar.data_port.foreign == 0 ? fmt::format("nothing has come on {}{}", port_, position)
                                          : fmt::format("datagrams on {} come from others than {}",
                                                        port_, settings_.lidar.sender);
    case sensor_health_t::SILENT:
      return fmt::format("no packets on {}{}", port_, position);
    case sensor_health_t::WRONG_DATA:
      return fmt::format("datagrams on {} are not packets of a {}: {}", port_,
                         name_of(settings_.lidar.model), status_of(lidar, now_ns).main_reason());
    default:
      break;
  }
  if (lidar.without_return_ns > kReturnsStop) return "the lidar has no return: is it covered?";
  if (lidar.last_sweep_ns == 0) return "the lidar has not made a whole turn yet";
  if (lidar.last_packet_ns - lidar.last_sweep_ns > kTurnStops)
    return "the lidar makes no whole turns: does it turn?";
  if (now_ns - detector.last_loop_ns > kDetectorStops) return "the detector is late";
  if (detector.last_list_ns == 0) return "no sweep has got through the detector yet";
  if (now_ns - detector.last_list_ns > kOldData)
    return "sweeps come, but no list of the last half second has gone out";
  return detector.setup.is_grave() ? sentence(detector.setup.findings[0]) : "";
}

/// Logs one reason only once in a while: a detector may be late with every other sweep.
void HealthWatch::log_sight(std::int64_t now_ns, const std::string& reason) {
  const bool sees = reason.empty();
  if (!sees) logs_sight_ = reason != logged_reason_ || now_ns - logged_at_ns_ >= kLogPauseNs;
  if (!logs_sight_) return;
  add_line(!sees, sees ? "sees: obstacle lists go out" : "blind: " + reason);
  if (sees) return;
  logged_reason_ = reason;
  logged_at_ns_ = now_ns;
}

void HealthWatch::log_losses(std::int64_t now_ns, const LidarStatus& lidar,
                             const DetectorStatus& detector) {
  struct Loss {
    std::uint64_t count;
    std::string_view what;
  };
  const std::array<Loss, kLosses> losses = {{
      {lidar.sweeps_dropped, "sweeps left out: the detector was busy"},
      {detector.not_covered,
       "sweeps went on without the samples of IMU or encoder that cover them: those came later "
       "than map.wait"},
      {detector.slips,
       "sweeps during which the wheel slipped: it was not believed; if that never ends, "
       "encoder.scale is wrong, or its sign"},
      {detector.heading_resets,
       "turns of the IMU's yaw that its angular rate did not know of: they were not believed"},
      {detector.not_sent,
       "messages that LCM did not take: is the network up, and does the server of lcm.url read?"},
      {detector.drops.obstacles + detector.drops.tracks,
       "obstacles found no room, and the farthest are left out: raise memory.obstacles"},
      {detector.drops.map_points, "points found no room in the map: raise memory.map_voxels"},
      {detector.drops.points, "points of sweeps found no room: raise memory.sweep_points"},
  }};
  for (std::size_t i = 0; i < kLosses; ++i) {
    losses_[i].update(now_ns, losses[i].count, losses[i].what, log_);
  }
}

void HealthWatch::log_first_packets(const LidarStatus& lidar) {
  if (!logged_datagram_ && lidar.last_datagram_ns != 0) {
    add_line(false, fmt::format("first datagram on {} is from {} and has {} bytes", port_,
                                ipv4_text(lidar.sender), lidar.datagram_size));
    logged_datagram_ = true;
  }
  if (!logged_packet_ && lidar.last_packet_ns != 0) {
    add_line(false,
             fmt::format("lidar: {}, {}", name_of(settings_.lidar.model), modes_of(lidar.lidar)));
    logged_packet_ = true;
  }
  if (lidar.firmware != logged_firmware_) {
    add_line(lidar.firmware == velodyne::Firmware::hdl32e, std::string(sentence(lidar.firmware)));
    logged_firmware_ = lidar.firmware;
  }
}

void HealthWatch::log_pulses(const LidarStatus& lidar) {
  if (!logged_pulse_ && lidar.pulses > 0) {
    add_line(false, "the pulse per second of gpio.pps comes");
    logged_pulse_ = true;
  }
  if (lidar.is_pps_lost != logged_pps_lost_) {
    add_line(lidar.is_pps_lost, lidar.is_pps_lost ? "the GPIO chip of gpio.pps is gone"
                                                  : "the line of gpio.pps is there again");
    logged_pps_lost_ = lidar.is_pps_lost;
  }
  if (lidar.pulses > 0 && lidar.has_no_pulse != logged_no_pulse_) {
    add_line(lidar.has_no_pulse, lidar.has_no_pulse
                                     ? "the lidar says that it hears no pulse per second: those of "
                                       "gpio.pps are not used; are both wired to one source?"
                                     : "the lidar hears the pulse per second");
    logged_no_pulse_ = lidar.has_no_pulse;
  }
}

}  // namespace scree
