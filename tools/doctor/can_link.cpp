#include "doctor/can_link.hpp"

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstring>

namespace scree {
namespace {

using Bytes = std::span<const std::uint8_t>;

/// @pre bytes.size() >= sizeof(T)
template <class T>
T read(Bytes bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

std::size_t aligned(std::size_t size) {
  return (size + RTA_ALIGNTO - 1) / RTA_ALIGNTO * RTA_ALIGNTO;
}

/// What an attribute of that type holds, among attributes one behind the other; empty: there is
/// none.
Bytes attribute(Bytes attributes, unsigned short type) {
  while (attributes.size() >= sizeof(rtattr)) {
    const auto header = read<rtattr>(attributes);
    if (header.rta_len < sizeof(rtattr) || header.rta_len > attributes.size()) return {};
    if ((header.rta_type & NLA_TYPE_MASK) == type) {
      return attributes.subspan(sizeof(rtattr), header.rta_len - sizeof(rtattr));
    }
    attributes = attributes.subspan(std::min(aligned(header.rta_len), attributes.size()));
  }
  return {};
}

std::string text_of(Bytes bytes) {
  const auto end = std::ranges::find(bytes, 0);
  return {bytes.begin(), end};
}

}  // namespace

std::optional<CanLink> parse_can_link(Bytes answer) {
  if (answer.size() < sizeof(nlmsghdr)) return std::nullopt;
  const auto header = read<nlmsghdr>(answer);
  if (header.nlmsg_type != RTM_NEWLINK || header.nlmsg_len > answer.size() ||
      header.nlmsg_len < sizeof(nlmsghdr) + sizeof(ifinfomsg)) {
    return std::nullopt;
  }
  answer = answer.first(header.nlmsg_len).subspan(sizeof(nlmsghdr));
  const auto interface = read<ifinfomsg>(answer);
  CanLink link;
  link.is_can = interface.ifi_type == ARPHRD_CAN;
  link.is_up = (interface.ifi_flags & IFF_UP) != 0;
  const Bytes info = attribute(answer.subspan(sizeof(ifinfomsg)), IFLA_LINKINFO);
  link.kind = text_of(attribute(info, IFLA_INFO_KIND));
  const Bytes data = attribute(info, IFLA_INFO_DATA);
  if (const Bytes timing = attribute(data, IFLA_CAN_BITTIMING);
      timing.size() >= sizeof(can_bittiming)) {
    link.bit_rate = read<can_bittiming>(timing).bitrate;
  }
  if (const Bytes restart = attribute(data, IFLA_CAN_RESTART_MS);
      restart.size() >= sizeof(std::uint32_t)) {
    link.restart_ms = read<std::uint32_t>(restart);
  }
  return link;
}

Finding check_can_link(const std::string& interface, const std::optional<CanLink>& link) {
  const std::string subject = "CAN interface";
  if (!link) {
    return wrong(subject,
                 fmt::format("there is no {}: plug the adapter in, or set encoder.interface to "
                             "one that `ip link` lists",
                             interface));
  }
  if (!link->is_can) {
    return wrong(subject, fmt::format("{} is no CAN interface: set encoder.interface", interface));
  }
  const bool has_bit_rate = link->kind == "can";
  if (!link->is_up) {
    return wrong(subject,
                 fmt::format("{0} is down: ip link set {0} up{1}", interface,
                             has_bit_rate ? " type can bitrate 500000 restart-ms 100, with "
                                            "the bit rate of the bus"
                                          : ""));
  }
  if (!has_bit_rate) return ok(subject, fmt::format("{} is up ({})", interface, link->kind));
  if (link->restart_ms == 0) {
    return wrong(subject, fmt::format("{0} is up with {1} bit/s, but stays off the bus after too "
                                      "many errors: ip link set {0} down; ip link set {0} up type "
                                      "can bitrate {1} restart-ms 100",
                                      interface, link->bit_rate));
  }
  return ok(subject, fmt::format("{} is up, {} bit/s, back on the bus {} ms after bus-off",
                                 interface, link->bit_rate, link->restart_ms));
}

Finding check_can_traffic(const std::string& interface, std::int64_t can_id,
                          const CanTraffic& traffic) {
  const std::string subject = "encoder";
  if (!traffic.bus_advice.empty()) return wrong(subject, interface + ": " + traffic.bus_advice);
  if (traffic.wanted > 0) {
    return ok(subject, fmt::format("{:.0f} frames a second with identifier 0x{:X} on {}",
                                   static_cast<double>(traffic.wanted) / traffic.seconds, can_id,
                                   interface));
  }
  if (traffic.others > 0) {
    return wrong(subject,
                 fmt::format("no frame with encoder.can_id = 0x{:X} on {}, but {} others, "
                             "as 0x{:X} (`candump {}` shows them)",
                             can_id, interface, traffic.others, traffic.other_id, interface));
  }
  return wrong(subject, fmt::format("no frame on {} in {:g} s: check the encoder's power, the "
                                    "cable, the terminators and the bit rate",
                                    interface, traffic.seconds));
}

}  // namespace scree
