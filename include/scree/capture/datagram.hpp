#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace scree {

inline constexpr std::size_t kUdpHeader = 8;  ///< bytes (RFC 768)

/// A UDP datagram of a capture. The payload lies in the reader's memory until its next read.
struct Datagram {
  std::int64_t arrival_ns = 0;  ///< host time
  std::uint32_t source = 0;     ///< IPv4 address, most significant byte first in value
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
  std::span<const std::uint8_t> payload;
};

/// What a captured frame turned out to be.
enum class FrameKind : std::uint8_t {
  udp,
  other,      ///< not UDP over IPv4, or not understood
  fragment,   ///< part of a fragmented datagram
  truncated,  ///< cut by the capture's snap length, or inconsistent with its own lengths
};

/// The link types that are understood, as libpcap names them (DLT_*).
bool is_network_link(int link_type);

/// The IPv4 packet in a captured frame of these link types, perhaps with padding behind it.
std::optional<std::span<const std::uint8_t>> ipv4_packet(int link_type,
                                                         std::span<const std::uint8_t> frame);

/// Finds the UDP datagram in a captured frame: Ethernet (with VLAN tags), Linux cooked capture v1
/// and v2, raw IP, BSD loopback; IPv4 with options. `original_size` is the frame's size on the
/// wire, of which `frame` may be a part. Any bytes are safe. Fills all of `datagram` but
/// arrival_ns, and only when it returns udp.
FrameKind parse_frame(int link_type, std::span<const std::uint8_t> frame, std::size_t original_size,
                      Datagram& datagram);

}  // namespace scree
