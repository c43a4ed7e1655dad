#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "scree/clock/device_clock.hpp"
#include "scree/config/settings.hpp"
#include "scree/core/sweep.hpp"
#include "scree/drivers/velodyne/data_packet.hpp"
#include "scree/drivers/velodyne/firmware.hpp"
#include "scree/drivers/velodyne/one_clock.hpp"
#include "scree/drivers/velodyne/sweep_builder.hpp"

namespace scree::velodyne {

struct LidarCounters {
  std::uint64_t accepted = 0;                         ///< packets decoded
  std::array<std::uint64_t, kRefusals> refused{};     ///< by Refusal; [none] stays 0
  std::array<std::uint64_t, 3> by_mode{};             ///< accepted: strongest, last, dual
  std::uint64_t lost = 0;                             ///< packets missing between accepted ones
  std::uint64_t sweeps = 0;                           ///< handed out, each the end of a turn
  std::uint64_t standing = 0;                         ///< sweeps during which it did not turn
  std::uint64_t parts = 0;                            ///< handed out before the end of their turn
  std::uint64_t dropped = 0;                          ///< points beyond a sweep's capacity
  std::uint64_t device_restarts = 0, host_steps = 0;  ///< see DeviceClock

  std::uint64_t all_refused() const;
};

/// A decoded packet on the host's clock.
struct DecodedPacket {
  std::uint64_t index;   ///< counts accepted packets from 0
  std::int64_t time_ns;  ///< host time of the first shot; add Shots::time_ns
  const Shots& shots;
};

/// All there is between the datagrams of the data port and sweeps on the host's clock; the daemon
/// and the tools use it alike. Packets that overtook others by less than 8 ms are put in order.
/// Allocates when it is made and never again. Deterministic.
///
/// A packet's device time is that of its first shot; it leaves the sensor after the last one.
/// Points of a sweep have the spacing of the device's clock, and the sweep as a whole is laid on
/// the host's clock when it ends.
class LidarStream {
public:
  using OnSweep = std::function<void(Sweep&)>;
  using OnPacket = std::function<void(const DecodedPacket&)>;

  /// `on_sweep` may swap the sweep with another one of kSweepCapacity. Ranges are not limited and
  /// the mount is not applied here.
  /// @param parts of a turn, see SweepBuilder
  LidarStream(const LidarSettings& settings, OnSweep on_sweep, OnPacket on_packet = {},
              int parts = 1);
  LidarStream(const LidarStream&) = delete;
  LidarStream& operator=(const LidarStream&) = delete;

  /// Takes a datagram that arrived on the data port. Any bytes are safe.
  void take(Bytes datagram, std::int64_t arrival_ns);
  /// At the end of a capture: hands out the last, partial sweep.
  void flush();

  const LidarCounters& counters() const { return counters_; }
  /// How long there has been no return in what the sensor sent.
  std::int64_t without_return_ns() const { return builder_.without_return_ns(); }
  /// Whether product byte 0x21 was seen and what it turned out to be; see sentence().
  Firmware firmware() const { return firmware_detector_.firmware(); }
  /// The host's time of an edge of the pulse per second that the sensor is locked to.
  void pps(std::int64_t host_edge_ns) { clock_.pps(host_edge_ns); }
  const DeviceClock& clock() const { return clock_; }

private:
  struct Held {
    std::array<std::uint8_t, kDataPacketSize> bytes;
    std::int64_t arrival_ns;
  };
  /// What the next packet is compared with.
  struct Previous {
    std::int64_t device_ns;    ///< does not wrap
    std::int64_t duration_ns;  ///< until the next packet's time stamp, when none is lost
  };

  void hand_out(Sweep& sweep);
  void refuse(Refusal reason) { ++counters_.refused[static_cast<std::size_t>(reason)]; }
  void hold(Bytes packet, std::int64_t arrival_ns);
  void release(bool accept_them);
  std::int64_t elapsed_ns(Bytes packet) const;
  std::int64_t gap_ns(Bytes packet) const;
  void put_in_order(Bytes packet, std::int64_t arrival_ns);
  void keep_early(Bytes packet, std::int64_t arrival_ns);
  void accept_first_early();
  void accept(Bytes packet, std::int64_t arrival_ns);
  void count_lost(std::int64_t elapsed_ns);

  PacketDecoder decoder_;
  LidarModel model_;
  OnSweep on_sweep_;
  OnPacket on_packet_;
  SweepBuilder builder_;
  OneClock one_clock_;
  DeviceClock clock_{kHourNs};
  FirmwareDetector firmware_detector_;
  std::array<Held, 32> held_{};  ///< packets with product byte 0x21 until it is decided
  std::size_t held_count_ = 0;
  std::array<Held, 6> early_{};  ///< packets that came before others that were sent before them
  std::size_t early_count_ = 0;
  std::optional<Previous> previous_;
  /// Azimuth where the field of view that is set in the sensor begins, hundredths of a degree; -1
  /// where none is known.
  float field_of_view_begin_ = -1;
  Shots shots_;
  LidarCounters counters_;
};

}  // namespace scree::velodyne
