#include "read/lidar_capture.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdio>

#include "commands.hpp"
#include "scree/capture/capture.hpp"
#include "scree/core/ipv4.hpp"

namespace scree::cli {
namespace {

using velodyne::kRefusalReasons;
using velodyne::LidarCounters;
using velodyne::LidarStream;

/// The reason that most packets were refused for.
std::string_view main_refusal(const LidarCounters& counters) {
  const auto most = std::max_element(counters.refused.begin(), counters.refused.end());
  const auto reason = static_cast<std::size_t>(most - counters.refused.begin());
  if (reason == static_cast<std::size_t>(velodyne::Refusal::duplicate) &&
      *most > counters.accepted) {
    return "their time stamps stand still: does what wrote them know the sensor's?";
  }
  return kRefusalReasons[reason];
}

}  // namespace

std::string missing(const LidarCounters& counters) {
  constexpr double kMany = 0.05;  // of the packets
  const std::uint64_t sent = counters.accepted + counters.lost;
  const double share = static_cast<double>(counters.lost) / static_cast<double>(sent);
  if (sent == 0 || share < kMany) return "";
  return fmt::format(
      "{} of {} packets of the lidar are missing ({:.0f} %): what they saw is not "
      "looked at",
      counters.lost, sent, 100 * share);
}

std::string standing(const LidarCounters& counters) {
  if (counters.standing == 0) return "";
  return fmt::format("the lidar did not turn in {} of its {} sweeps: they give no list",
                     counters.standing, counters.sweeps);
}

Settings capture_settings(const std::filesystem::path& capture,
                          const std::filesystem::path& config) {
  const auto file = settings_file(capture, config);
  return file ? value_or_fail(load_settings(*file)) : Settings{};
}

LidarCapture::LidarCapture(const std::filesystem::path& capture, const Settings& settings,
                           const HostSteps& steps)
    : name_(capture.string()),
      file_(capture, settings.lidar),
      steady_(steps),
      settings_(settings.lidar) {}

void LidarCapture::play(LidarStream& stream, const OnDatagram& on_other,
                        const std::function<void(std::int64_t)>& before) {
  Progress progress(name_, file_.size());
  Datagram datagram;
  while (file_.next(datagram)) {
    progress(file_.position());
    datagram.arrival_ns = steady_(datagram.arrival_ns);
    if (datagrams_++ == 0) first_ns_ = datagram.arrival_ns;
    last_ns_ = datagram.arrival_ns;
    if (before) before(datagram.arrival_ns);
    PortTraffic& traffic = ports_[datagram.destination_port];
    ++traffic.datagrams;
    ++traffic.sizes[datagram.payload.size()];
    const bool has_source = datagram.source != 0;
    if (has_source) ++traffic.senders[datagram.source];
    const bool wanted =
        !has_source || settings_.sender.empty() || ipv4_text(datagram.source) == settings_.sender;
    if (datagram.destination_port == settings_.port && wanted) {
      const bool is_data = datagram.payload.size() == velodyne::kDataPacketSize;
      if (is_data && !senders_.takes(datagram.source, datagram.arrival_ns)) continue;
      stream.take(datagram.payload, datagram.arrival_ns);
    } else if (on_other) {
      on_other(datagram);
    }
  }
  stream.flush();
}

double LidarCapture::seconds() const {
  return static_cast<double>(last_ns_ - first_ns_) * 1e-9;
}

std::string LidarCapture::two_senders() const {
  if (const std::string channels = file_.other_channels(); !channels.empty()) {
    return fmt::format("{}: {}", name_, channels);
  }
  if (senders_.left_out() == 0) return "";
  return fmt::format(
      "{}: two sensors send to port {}: the packets from {} are taken, {} from {} are "
      "left out; choose one with lidar.sender",
      name_, settings_.port, ipv4_text(senders_.taken()), senders_.left_out(),
      ipv4_text(senders_.other()));
}

std::string LidarCapture::why_nothing(const LidarStream& stream) const {
  const LidarCounters& counters = stream.counters();
  const std::uint64_t refused = counters.all_refused();
  if (refused > 0) {
    return fmt::format("{}: all {} packets to port {} are refused: {}", name_, refused,
                       settings_.port, main_refusal(counters));
  }
  if (const auto own = ports_.find(static_cast<std::uint16_t>(settings_.port));
      own != ports_.end()) {
    return fmt::format("{}: the {} packets to port {} come from {}, not from lidar.sender = {}",
                       name_, own->second.datagrams, settings_.port,
                       ipv4_text(own->second.senders.begin()->first), settings_.sender);
  }
  if (ports_.empty()) {
    const FrameCounters& seen = frames();
    if (seen.truncated > 0) {
      return fmt::format(
          "{}: all {} packets were cut when they were captured (tcpdump -s 0 keeps "
          "them whole)",
          name_, seen.truncated);
    }
    if (file_.is_log()) {
      return fmt::format("{}: none of its {} LCM messages holds a packet of the lidar", name_,
                         seen.other);
    }
    if (seen.fragments > 0) {
      return fmt::format("{}: all {} packets are fragments, of which the others are missing", name_,
                         seen.fragments);
    }
    return fmt::format("{}: no UDP packets over IPv4 in {} frames", name_, seen.other);
  }
  const auto busiest = std::max_element(
      ports_.begin(), ports_.end(),
      [](const auto& a, const auto& b) { return a.second.datagrams < b.second.datagrams; });
  const std::uint64_t count = busiest->second.datagrams;
  if (frames().truncated > 0) {
    return fmt::format(
        "{}: no whole packets to port {}; {} were cut when they were captured "
        "(tcpdump -s 0 keeps them whole)",
        name_, settings_.port, frames().truncated);
  }
  if (seconds() <= 0) {
    return fmt::format("{}: no packets to port {}, but {} to {}", name_, settings_.port, count,
                       busiest->first);
  }
  return fmt::format("{}: no packets to port {}, but {:.0f} a second to {}", name_, settings_.port,
                     static_cast<double>(count) / seconds(), busiest->first);
}

void report_capture(const LidarCapture& capture, const LidarStream& stream) {
  const auto note = [](std::string_view text) {
    if (!text.empty()) fmt::print(stderr, "scree: {}\n", text);
  };
  if (capture.ports().empty() && !capture.broken_off().empty()) throw Failure(capture.broken_off());
  note(capture.broken_off());
  if (stream.counters().accepted == 0) throw Failure(capture.why_nothing(stream));
  note(capture.two_senders());
  note(velodyne::sentence(stream.firmware()));
  const LidarCounters& counters = stream.counters();
  if (const std::uint64_t refused = counters.all_refused(); refused > 0) {
    note(fmt::format("{} packets refused, most of them: {}", refused, main_refusal(counters)));
  }
  note(missing(counters));
  note(standing(counters));
}

}  // namespace scree::cli
