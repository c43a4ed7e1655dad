#pragma once

#include <array>
#include <cstdint>

#include "event.hpp"
#include "loop_counter.hpp"
#include "scree/app/robot_lines.hpp"
#include "scree/clock/host_clock.hpp"
#include "scree/config/settings.hpp"
#include "scree/core/result.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"
#include "scree/drivers/velodyne/udp_receiver.hpp"
#include "sensor_status.hpp"
#include "timed_sweep.hpp"
#include "triple_buffer.hpp"

namespace scree {

class Keeper;

/// The lidar's two ports, bound.
struct LidarPorts {
  UdpReceiver data, position;

  static Result<LidarPorts> open(const LidarSettings& settings);
};

/// Reads the lidar's two ports, and the pulses that its clock is locked to, and hands over each
/// complete sweep, on the monotonic clock. run() is the work of a thread; it allocates nothing and
/// blocks only in poll().
class LidarReader {
public:
  LidarReader(const Settings& settings, LidarPorts ports, RobotLines::Pulses pps, SweepPool& sweeps,
              Keeper* keeper = nullptr);

  /// Returns after stop() was called from another thread.
  void run();
  void stop() { stop_.wake(); }

  /// For one other thread: what was seen so far.
  const LidarStatus& status() { return shared_status_.get(); }
  const LoopCounter& loops() const { return loops_; }

private:
  void read_data();
  void read_position();
  int find_pulses();
  void read_pulses();
  void push(Sweep& sweep);

  LidarPorts ports_;
  RobotLines::Pulses pps_;
  std::int64_t pps_tried_ns_ = 0;
  SweepPool& sweeps_;
  Keeper* keeper_;  // gets the packets; null: nobody does
  HostClock clock_;
  velodyne::LidarStream stream_;
  LidarStatus status_;
  TripleBuffer<LidarStatus> shared_status_;
  LoopCounter loops_;
  Event stop_;
  std::int64_t arrival_ns_ = 0;              // of the datagram under way
  std::array<std::uint8_t, 2048> buffer_{};  // longer than a packet, to tell the size of others
};

}  // namespace scree
