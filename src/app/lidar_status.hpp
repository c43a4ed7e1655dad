#pragma once

#include <array>
#include <cstdint>

#include "scree/drivers/velodyne/refusal.hpp"
#include "scree/drivers/velodyne/udp_receiver.hpp"
#include "scree/drivers/velodyne/wire.hpp"

namespace scree {

/// What the lidar's reader thread has seen since the start. Times are of the steady clock, 0 before
/// the first.
struct LidarStatus {
  UdpCounts data_port;
  std::uint32_t sender = 0;         ///< of the last datagram
  std::uint32_t datagram_size = 0;  ///< of the last datagram
  std::int64_t last_datagram_ns = 0;

  std::uint64_t packets = 0, position_packets = 0, lost_packets = 0;
  std::array<std::uint64_t, velodyne::kRefusals> refused{};
  velodyne::Refusal last_refusal = velodyne::Refusal::none;
  std::int64_t last_packet_ns = 0;  ///< of a data packet that was accepted
  velodyne::ReturnMode return_mode = velodyne::ReturnMode::strongest;
  bool is_early_firmware = false;  ///< product byte 0x21 and the timing of a VLP-16

  std::uint64_t sweeps = 0, sweeps_dropped = 0, points_dropped = 0;
  bool is_last_sweep_empty = false;
};

}  // namespace scree
