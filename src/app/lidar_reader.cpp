#include "lidar_reader.hpp"

#include <poll.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "keeper.hpp"
#include "scree/clock/clocks.hpp"
#include "scree/core/nanoseconds.hpp"
#include "scree/drivers/velodyne/position_packet.hpp"

namespace scree {
namespace {

// Datagrams read from one port before the other one and stop() get their turn: 85 ms of a VLP-16's,
// which sends one every 1.327 ms.
constexpr int kBatch = 64;

}  // namespace

Result<LidarPorts> LidarPorts::open(const LidarSettings& settings) {
  auto data = UdpReceiver::open(settings.address, settings.port, settings.sender);
  if (!data) return tl::make_unexpected(data.error());
  auto position = UdpReceiver::open(settings.address, settings.position_port, settings.sender);
  if (!position) return tl::make_unexpected(position.error());
  return LidarPorts{std::move(*data), std::move(*position)};
}

LidarReader::LidarReader(const Settings& settings, LidarPorts ports, RobotLines::Pulses pps,
                         SweepPool& sweeps, Keeper* keeper)
    : ports_(std::move(ports)),
      pps_(std::move(pps)),
      sweeps_(sweeps),
      keeper_(keeper),
      stream_(
          settings.lidar, [this](Sweep& sweep) { push(sweep); }, {},
          settings.detect.lists_per_turn) {}

void LidarReader::run() {
  pollfd wait_for[] = {{ports_.data.descriptor(), POLLIN, 0},
                       {ports_.position.descriptor(), POLLIN, 0},
                       {-1, POLLIN, 0},
                       {stop_.descriptor(), POLLIN, 0}};
  while (true) {
    loops_.increment();
    if (wait_for[2].fd < 0) wait_for[2].fd = find_pulses();
    if (poll(wait_for, std::size(wait_for), kMaxWaitMs) < 0) continue;  // a signal came between
    if (wait_for[3].revents != 0) return;
    if ((wait_for[2].revents & POLLIN) != 0) {
      read_pulses();
    } else if (wait_for[2].revents != 0) {
      pps_.close();  // its chip is gone
      wait_for[2].fd = -1;
      status_.is_pps_lost = true;
    }
    if (wait_for[0].revents != 0) read_data();
    if (wait_for[1].revents != 0) read_position();
    status_.data_port = ports_.data.counts();
    status_.clock = stream_.clock().status(wall_ns() - steady_ns());
    shared_status_.put(status_);
  }
}

void LidarReader::read_data() {
  for (int i = 0; i < kBatch; ++i) {
    const auto datagram = ports_.data.receive(buffer_);
    if (!datagram) break;
    // What waited while this process was paused is as old as the kernel says.
    arrival_ns_ = std::min(clock_.to_monotonic(datagram->arrival_ns, read_clocks()), steady_ns());
    const bool is_data = datagram->bytes.size() == velodyne::kDataPacketSize;
    if (is_data && !status_.senders.takes(datagram->sender, arrival_ns_)) continue;
    status_.sender = datagram->sender;
    status_.datagram_size = static_cast<std::uint32_t>(datagram->bytes.size());
    status_.last_datagram_ns = arrival_ns_;
    if (keeper_ != nullptr && is_data) keeper_->put_packet(datagram->bytes);
    const std::uint64_t accepted = stream_.counters().accepted;
    stream_.take(datagram->bytes, arrival_ns_);
    if (stream_.counters().accepted != accepted) status_.last_packet_ns = arrival_ns_;
  }
  status_.lidar = stream_.counters();
  status_.firmware = stream_.firmware();
  status_.without_return_ns = stream_.without_return_ns();
}

void LidarReader::read_position() {
  for (int i = 0; i < kBatch; ++i) {
    const auto datagram = ports_.position.receive(buffer_);
    if (!datagram) return;
    const auto packet = velodyne::parse_position_packet(datagram->bytes);
    if (!packet) continue;
    ++status_.position_packets;
    status_.last_position_ns = steady_ns();
    status_.has_no_pulse = packet->pps == velodyne::PpsStatus::absent;
  }
}

/// The descriptor of their line, looked for once a second; -1: none.
int LidarReader::find_pulses() {
  if (!pps_.descriptor || steady_ns() - pps_tried_ns_ < kSecond) return -1;
  pps_tried_ns_ = steady_ns();
  const int descriptor = pps_.descriptor();
  status_.is_pps_lost = descriptor < 0;
  return descriptor;
}

/// To a lidar that says that it hears no pulse they mean nothing.
void LidarReader::read_pulses() {
  while (const auto pulse_ns = pps_.read()) {
    if (!status_.has_no_pulse) stream_.pps(clock_.to_monotonic(*pulse_ns, read_clocks()));
    ++status_.pulses;
  }
}

void LidarReader::push(Sweep& sweep) {
  if (sweep.is_whole && sweep.ends_turn) status_.last_sweep_ns = arrival_ns_;
  // Nothing seen is not the same as nothing there: a covered sensor must not give empty lists.
  if (sweep.points.empty()) {
    if (sweep.ends_turn) ++status_.sweeps_empty;
    return;
  }
  // The last free place is for a turn's end.
  const QueueFill fill = sweeps_.fill();
  if (!sweep.ends_turn && fill.waiting + 1 >= fill.capacity) {
    ++status_.parts_dropped;
    return;
  }
  TimedSweep* item = sweeps_.acquire();
  if (item == nullptr) {
    ++status_.sweeps_dropped;
    return;
  }
  std::swap(item->sweep, sweep);
  item->arrival_ns = arrival_ns_;
  sweeps_.push(item);
}

}  // namespace scree
