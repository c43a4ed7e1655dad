#include "scree/capture/datagram.hpp"

#include <pcap/dlt.h>
#include <spdlog/fmt/fmt.h>

namespace scree {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint16_t kEtherIpv4 = 0x0800;
constexpr std::uint8_t kProtocolUdp = 17;

/// A number in network byte order. @pre offset + 2 <= bytes.size()
std::uint16_t network_u16(Bytes bytes, std::size_t offset) {
  return static_cast<std::uint16_t>(bytes[offset] << 8 | bytes[offset + 1]);
}

std::uint32_t network_u32(Bytes bytes, std::size_t offset) {
  return std::uint32_t{network_u16(bytes, offset)} << 16 | network_u16(bytes, offset + 2);
}

/// The IPv4 packet behind a header of `size` bytes with the EtherType at `type_offset`.
std::optional<Bytes> behind_ether_type(Bytes frame, std::size_t type_offset, std::size_t size) {
  if (frame.size() < size) return std::nullopt;
  std::uint16_t type = network_u16(frame, type_offset);
  // VLAN tags (802.1Q, 802.1ad, and the older 0x9100), any number of them.
  while (type == 0x8100 || type == 0x88A8 || type == 0x9100) {
    if (frame.size() < size + 4) return std::nullopt;
    type = network_u16(frame, size + 2);
    size += 4;
  }
  if (type != kEtherIpv4) return std::nullopt;
  return frame.subspan(size);
}

}  // namespace

bool is_network_link(int link_type) {
  switch (link_type) {
    case DLT_EN10MB:
    case DLT_LINUX_SLL:
    case DLT_LINUX_SLL2:
    case DLT_RAW:
    case DLT_IPV4:
    case DLT_NULL:
    case DLT_LOOP:
      return true;
    default:
      return false;
  }
}

std::optional<Bytes> ipv4_packet(int link_type, Bytes frame) {
  switch (link_type) {
    case DLT_EN10MB:
      return behind_ether_type(frame, 12, 14);
    case DLT_LINUX_SLL:
      return behind_ether_type(frame, 14, 16);
    case DLT_LINUX_SLL2:
      return behind_ether_type(frame, 0, 20);
    case DLT_RAW:
    case DLT_IPV4:
      return frame;
    case DLT_NULL:
    case DLT_LOOP: {
      // The address family, 2 for IPv4, in the byte order of whatever machine captured it.
      if (frame.size() < 4) return std::nullopt;
      const std::uint32_t family = network_u32(frame, 0);
      if (family != 2 && family != 0x02000000) return std::nullopt;
      return frame.subspan(4);
    }
    default:
      return std::nullopt;
  }
}

FrameKind parse_frame(int link_type, Bytes frame, std::size_t original_size, Datagram& datagram) {
  const bool cut = frame.size() < original_size;
  const FrameKind broken = cut ? FrameKind::truncated : FrameKind::other;
  const std::optional<Bytes> network = ipv4_packet(link_type, frame);
  if (!network) return broken;
  Bytes ip = *network;
  if (ip.size() < 20) return broken;
  if (ip[0] >> 4 != 4 || ip[9] != kProtocolUdp) return FrameKind::other;
  const std::size_t ip_header = (ip[0] & std::size_t{0x0F}) * 4, ip_size = network_u16(ip, 2);
  if (ip_header < 20) return FrameKind::other;
  // More fragments to come, or an offset into the datagram.
  if ((network_u16(ip, 6) & 0x3FFF) != 0) return FrameKind::fragment;
  // A length of 0 is what a network card with segmentation offload leaves behind; short frames are
  // padded behind the packet.
  if (ip_size != 0 && ip_size < ip.size()) ip = ip.first(ip_size);
  if (ip.size() < ip_header + kUdpHeader) return FrameKind::truncated;
  const Bytes udp = ip.subspan(ip_header);
  const std::size_t udp_size = network_u16(udp, 4);
  if (udp_size < kUdpHeader || udp_size > udp.size()) return FrameKind::truncated;

  datagram.source = network_u32(ip, 12);
  datagram.source_port = network_u16(udp, 0);
  datagram.destination_port = network_u16(udp, 2);
  datagram.payload = udp.subspan(kUdpHeader, udp_size - kUdpHeader);
  return FrameKind::udp;
}

}  // namespace scree
