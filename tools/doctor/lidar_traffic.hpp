#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "doctor/finding.hpp"
#include "scree/config/settings.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"

namespace scree {

/// Datagrams of one kind. Addresses are IPv4, most significant byte first in value.
struct DatagramKind {
  std::uint32_t sender = 0, destination = 0;
  int port = 0;
  std::size_t size = 0;  ///< bytes of payload

  bool operator<(const DatagramKind& other) const {
    return std::tie(sender, destination, port, size) <
           std::tie(other.sender, other.destination, other.port, other.size);
  }
};
using DatagramCounts = std::map<DatagramKind, std::uint64_t>;

/// What came to this computer while it was listened for.
struct LidarTraffic {
  /// Through a socket on lidar.port, of any sender; the destination is not known.
  DatagramCounts heard;
  /// Datagrams on lidar.position_port.
  std::uint64_t position_packets = 0;
  /// What screed's own check says of the data packets that came.
  velodyne::LidarCounters packets;
  std::int64_t without_return_ns = 0;  ///< as LidarStream tells it
  /// Off the wire, before any firewall, to any port and address; nothing without the right to.
  std::optional<DatagramCounts> seen;
  std::vector<std::uint32_t> own_addresses;
  double seconds = 0;
};

/// From whom the lidar's packets come and how many, or why they do not.
Finding check_lidar_traffic(const LidarSettings& lidar, const LidarTraffic& traffic);

}  // namespace scree
