#include "read/host_steps.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "read/lidar_file.hpp"
#include "scree/core/nanoseconds.hpp"
#include "scree/drivers/velodyne/data_packet.hpp"

namespace scree::cli {
namespace {

/// Watches the packets of a lidar for a jump of the host's clock against the device's.
class StepFinder {
public:
  void add(std::int64_t arrival_ns, std::int64_t device_ns) {
    if (last_) {
      const std::int64_t elapsed = wrapped(device_ns - last_->device_ns);
      // A device that was away or has started anew says nothing.
      if (elapsed <= 0 || elapsed > kLongestPause) {
        jump_.reset();
      } else if (!jump_) {
        notice(arrival_ns - last_->arrival_ns - elapsed, elapsed);
      } else {
        confirm(arrival_ns, elapsed);
      }
    }
    last_ = Packet{arrival_ns, device_ns};
  }
  HostSteps take() { return std::move(steps_); }

private:
  static constexpr std::int64_t kLongestPause = 500 * kMillisecond;
  static constexpr std::int64_t kLeastJump = 30 * kMillisecond;
  static constexpr std::int64_t kCertainAfter = 300 * kMillisecond;

  struct Packet {
    std::int64_t arrival_ns, device_ns;
  };
  struct Jump {
    HostStep step;
    std::int64_t since_ns;  // by the device
  };

  static std::int64_t wrapped(std::int64_t elapsed_ns) {
    return (elapsed_ns % velodyne::kHourNs + velodyne::kHourNs) % velodyne::kHourNs;
  }
  void notice(std::int64_t by_ns, std::int64_t elapsed_ns) {
    if (std::abs(by_ns) >= kLeastJump) jump_ = {{last_->arrival_ns, by_ns}, elapsed_ns};
  }
  /// Packets that a busy host held up come with the next ones; after a step all are as late.
  void confirm(std::int64_t arrival_ns, std::int64_t elapsed_ns) {
    jump_->since_ns += elapsed_ns;
    const std::int64_t by_ns = arrival_ns - jump_->step.before_ns - jump_->since_ns;
    if (std::abs(by_ns) < std::abs(jump_->step.by_ns) / 2) return jump_.reset();
    if (std::abs(by_ns) < std::abs(jump_->step.by_ns)) jump_->step.by_ns = by_ns;
    if (jump_->since_ns < kCertainAfter) return;
    steps_.push_back(jump_->step);
    jump_.reset();
  }

  std::optional<Packet> last_;
  std::optional<Jump> jump_;
  HostSteps steps_;
};

}  // namespace

HostSteps find_host_steps(const std::filesystem::path& capture, const LidarSettings& lidar) {
  LidarFile file(capture, lidar);
  StepFinder finder;
  Datagram datagram;
  std::optional<std::uint32_t> sender;
  while (file.next(datagram)) {
    if (datagram.destination_port != lidar.port) continue;
    if (datagram.payload.size() != velodyne::kDataPacketSize) continue;
    if (!sender) sender = datagram.source;
    if (*sender != datagram.source) continue;
    finder.add(datagram.arrival_ns, std::int64_t{velodyne::timestamp_us(datagram.payload)} * 1000);
  }
  return finder.take();
}

std::int64_t SteadyTime::operator()(std::int64_t time_ns) {
  while (passed_ < steps_.size()) {
    const HostStep& step = steps_[passed_];
    // Between the time before a step ahead and that after it there is no record.
    const bool is_passed = step.by_ns > 0 ? time_ns > step.before_ns + step.by_ns / 2
                                          : time_ns < last_ns_ + step.by_ns / 2;
    if (!is_passed) break;
    set_by_ns_ += step.by_ns;
    ++passed_;
  }
  last_ns_ = time_ns;
  return time_ns - set_by_ns_;
}

}  // namespace scree::cli
