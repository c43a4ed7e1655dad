#pragma once

#include <cstdint>

#include "scree/clock/device_clock.hpp"
#include "scree/drivers/encoder/can_socket.hpp"
#include "scree/drivers/encoder/encoder_stream.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"
#include "scree/drivers/velodyne/one_sender.hpp"
#include "scree/drivers/velodyne/udp_receiver.hpp"
#include "scree/drivers/xsens/imu_stream.hpp"

// What the sensors' reader threads have seen since the start. Times are of the steady clock, 0
// before the first; offsets of clocks are those of the wall clock.
namespace scree {

struct LidarStatus {
  UdpCounts data_port;
  std::uint32_t sender = 0;         ///< of the last datagram
  std::uint32_t datagram_size = 0;  ///< of the last datagram
  std::int64_t last_datagram_ns = 0;
  velodyne::OneSender senders;  ///< of data packets

  velodyne::LidarCounters lidar;
  velodyne::Firmware firmware = velodyne::Firmware::undecided;
  std::int64_t last_packet_ns = 0;  ///< of a data packet that was accepted
  std::uint64_t position_packets = 0;
  std::int64_t last_position_ns = 0;

  std::uint64_t pulses = 0;   ///< of the pulse per second
  bool is_pps_lost = false;   ///< its GPIO chip is gone
  bool has_no_pulse = false;  ///< the lidar's own word
  ClockStatus clock;

  std::int64_t without_return_ns = 0;
  std::int64_t last_sweep_ns = 0;    ///< when a whole turn was complete
  std::uint64_t sweeps_dropped = 0;  ///< the detector was busy
  std::uint64_t parts_dropped = 0;   ///< the same of parts of turns: what comes later holds them
  std::uint64_t sweeps_empty = 0;    ///< without a return
};

struct ImuStatus {
  xsens::ImuCounters imu;
  std::int64_t last_bytes_ns = 0;
  std::int64_t last_message_ns = 0;  ///< of a useful sample, see ImuCounters
  ClockStatus clock;
};

struct EncoderStatus {
  encoder::CanSocketCounts socket;
  encoder::EncoderCounters encoder;
  encoder::BusState bus = encoder::BusState::silent;
  std::int64_t last_frame_ns = 0;   ///< of a frame that reports no error
  std::int64_t last_sample_ns = 0;  ///< of a frame that was accepted
};

}  // namespace scree
