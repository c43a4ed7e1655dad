#include "doctor/lidar_traffic.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "scree/core/ipv4.hpp"
#include "scree/drivers/velodyne/position_packet.hpp"
#include "scree/drivers/velodyne/wire.hpp"

namespace scree {
namespace {

using velodyne::kDataPacketSize;

/// Which kind came most often of those that it holds for; nothing: none did.
template <class Holds>
std::optional<std::pair<DatagramKind, std::uint64_t>> busiest(const DatagramCounts& counts,
                                                              Holds holds) {
  std::optional<std::pair<DatagramKind, std::uint64_t>> found;
  for (const auto& [kind, count] : counts) {
    if (holds(kind) && (!found || count > found->second)) found.emplace(kind, count);
  }
  return found;
}

bool is_data(const DatagramKind& kind) {
  return kind.size == kDataPacketSize;
}

/// 10.255.255.255 and the like are not told from a foreign address: the mask is not known.
bool is_for(const DatagramKind& kind, const std::vector<std::uint32_t>& own_addresses) {
  const bool is_broadcast_or_multicast =
      (kind.destination & 0xFF) == 0xFF || kind.destination >> 28 == 0xE;
  return is_broadcast_or_multicast || std::ranges::count(own_addresses, kind.destination) > 0;
}

std::string addresses(const std::vector<std::uint32_t>& all) {
  std::string text;
  for (const std::uint32_t one : all) text += (text.empty() ? "" : ", ") + ipv4_text(one);
  return text.empty() ? "none" : text;
}

/// Why packets that are on the wire do not come through the socket; empty: none are.
std::string why_not_heard(const LidarSettings& lidar, const LidarTraffic& traffic) {
  const auto on_wire = busiest(*traffic.seen, is_data);
  if (!on_wire) return "";
  const DatagramKind& kind = on_wire->first;
  const std::string what =
      fmt::format("packets of {} bytes from {}", kind.size, ipv4_text(kind.sender));
  if (!is_for(kind, traffic.own_addresses)) {
    return fmt::format(
        "{} go to {}, which is no address of this computer (it has {}): "
        "set the destination on the sensor's web page",
        what, ipv4_text(kind.destination), addresses(traffic.own_addresses));
  }
  if (kind.port != lidar.port) {
    return fmt::format(
        "{} go to UDP port {}: set lidar.port = {}, or the port on the "
        "sensor's web page",
        what, kind.port, kind.port);
  }
  return fmt::format(
      "{} reach this computer but not UDP port {}: a firewall drops them, the kernel "
      "(net.ipv4.conf.all.rp_filter) refuses a sender that it has no route to, or "
      "lidar.address = {} is not where they go",
      what, lidar.port, lidar.address);
}

std::string nothing_came(const LidarSettings& lidar, const LidarTraffic& traffic) {
  if (traffic.seen) {
    if (std::string why = why_not_heard(lidar, traffic); !why.empty()) return why;
  }
  if (traffic.position_packets > 0) {
    return fmt::format("nothing came to UDP port {}, but on {} {}", lidar.port, lidar.position_port,
                       velodyne::kPositionAlone);
  }
  return fmt::format(
      "nothing came to UDP port {} in {:g} s: check the sensor's power and cable, and "
      "the destination on its web page (http://192.168.1.201 by default; this "
      "computer is {}){}",
      lidar.port, traffic.seconds, addresses(traffic.own_addresses),
      traffic.seen ? "" : "; as root this looks at other ports and addresses too");
}

/// Why none of the packets is of use; empty: some are.
std::string why_of_no_use(const LidarTraffic& traffic) {
  constexpr std::int64_t kDark = 500'000'000;
  const auto& refused = traffic.packets.refused;
  const auto most = std::ranges::max_element(refused);
  if (*most > traffic.packets.accepted) {
    const auto reason = static_cast<std::size_t>(most - refused.begin());
    return fmt::format("{} of them refused: {}", *most, velodyne::kRefusalReasons[reason]);
  }
  return traffic.without_return_ns > kDark ? "no return in them: is it covered?" : "";
}

}  // namespace

Finding check_lidar_traffic(const LidarSettings& lidar, const LidarTraffic& traffic) {
  const std::string subject = "lidar";
  if (traffic.heard.empty()) return wrong(subject, nothing_came(lidar, traffic));
  const auto is_wanted = [&](const DatagramKind& kind) {
    return lidar.sender.empty() || ipv4_text(kind.sender) == lidar.sender;
  };
  const auto packets = busiest(
      traffic.heard, [&](const DatagramKind& kind) { return is_data(kind) && is_wanted(kind); });
  if (packets) {
    const auto& [kind, count] = *packets;
    const auto second = busiest(traffic.heard, [&](const DatagramKind& other) {
      return is_data(other) && is_wanted(other) && other.sender != packets->first.sender;
    });
    if (second) {
      return wrong(subject,
                   fmt::format("packets come from {} and from {}: screed takes those of one "
                               "of them, choose it with lidar.sender",
                               ipv4_text(kind.sender), ipv4_text(second->first.sender)));
    }
    const std::string what = fmt::format("{:.0f} packets a second of {} bytes from {}",
                                         static_cast<double>(count) / traffic.seconds, kind.size,
                                         ipv4_text(kind.sender));
    const std::string why = why_of_no_use(traffic);
    return why.empty() ? ok(subject, what) : wrong(subject, what + ", " + why);
  }
  const auto foreign = busiest(traffic.heard, is_data);
  if (foreign) {
    return wrong(subject,
                 fmt::format("packets come from {}, and lidar.sender = {} lets none of them in",
                             ipv4_text(foreign->first.sender), lidar.sender));
  }
  const auto other = busiest(traffic.heard, [](const DatagramKind&) { return true; });
  return wrong(
      subject,
      fmt::format("what comes to UDP port {} from {} has {} bytes, and a packet of the lidar "
                  "has {}: is this the sensor, and lidar.port its data port?",
                  lidar.port, ipv4_text(other->first.sender), other->first.size, kDataPacketSize));
}

}  // namespace scree
