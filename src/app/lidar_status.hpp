#pragma once

#include <cstdint>

#include "scree/drivers/velodyne/lidar_stream.hpp"
#include "scree/drivers/velodyne/udp_receiver.hpp"

namespace scree {

/// What the lidar's reader thread has seen since the start. Times are of the steady clock, 0 before
/// the first.
struct LidarStatus {
  UdpCounts data_port;
  std::uint32_t sender = 0;         ///< of the last datagram
  std::uint32_t datagram_size = 0;  ///< of the last datagram
  std::int64_t last_datagram_ns = 0;

  velodyne::LidarCounters lidar;
  velodyne::Firmware firmware = velodyne::Firmware::undecided;
  std::int64_t last_packet_ns = 0;  ///< of a data packet that was accepted
  std::uint64_t position_packets = 0;

  std::uint64_t pulses = 0;  ///< of the pulse per second
  bool is_pps_lost = false;  ///< its GPIO chip is gone
  ClockState clock = ClockState::unsynchronised;

  std::uint64_t sweeps_dropped = 0;  ///< the ring to the detector was full
  bool is_last_sweep_empty = false;
};

}  // namespace scree
