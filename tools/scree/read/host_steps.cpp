#include "read/host_steps.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "commands.hpp"
#include "read/lidar_file.hpp"
#include "scree/core/nanoseconds.hpp"
#include "scree/drivers/velodyne/data_packet.hpp"

namespace scree::cli {
namespace {

/// The least delay of packets lately, up to a constant: what a busy host held up tells nothing.
class LeastDelay {
public:
  /// @param device_ns runs on over the full hour
  void add(std::int64_t delay_ns, std::int64_t device_ns) {
    if (device_ns - since_ns_ >= kWindow) {
      before_ns_ = now_ns_;
      now_ns_ = delay_ns;
      since_ns_ = device_ns;
    }
    now_ns_ = std::min(now_ns_, delay_ns);
  }
  std::int64_t get() const { return std::min(before_ns_, now_ns_); }

private:
  static constexpr std::int64_t kWindow = kSecond;
  std::int64_t since_ns_ = 0, before_ns_ = INT64_MAX, now_ns_ = INT64_MAX;
};

/// Watches the packets of a lidar for a jump of the host's clock against the device's.
class StepFinder {
public:
  void add(std::int64_t arrival_ns, std::int64_t device_ns) {
    if (packets_++ == 0) first_arrival_ns_ = arrival_ns;
    if (arrival_ns != first_arrival_ns_) has_times_ = true;
    if (last_) {
      const std::int64_t elapsed = wrapped(device_ns - last_->device_ns);
      // A device that was away or has started anew says nothing.
      if (elapsed <= 0 || elapsed > kLongestPause) {
        jump_.reset();
        usual_ = {};
        last_.reset();
      } else {
        running_ns_ += elapsed;
      }
    }
    if (last_) notice(arrival_ns);
    if (!jump_) usual_.add(arrival_ns - running_ns_, running_ns_);
    last_ = Packet{arrival_ns, device_ns};
  }
  /// Many packets arrived, and all at one time.
  bool has_lost_times() const {
    constexpr int kMany = 100;  // 0.13 s of a lidar
    return packets_ > kMany && !has_times_;
  }
  /// At the end of the file.
  HostSteps take() {
    // What is held up for so long, or comes too early, is a step, however little follows it.
    constexpr std::int64_t kLongestDelay = kSecond;
    if (jump_) {
      const std::int64_t by_ns = jump_->delay.get() - usual_.get();
      if (by_ns < 0 || by_ns > kLongestDelay) steps_.push_back({jump_->before_ns, by_ns});
    }
    return std::move(steps_);
  }

private:
  static constexpr std::int64_t kLongestPause = 500 * kMillisecond;
  static constexpr std::int64_t kLeastJump = 30 * kMillisecond;
  static constexpr std::int64_t kCertainAfter = 300 * kMillisecond;

  struct Packet {
    std::int64_t arrival_ns, device_ns;
  };
  struct Jump {
    std::int64_t before_ns, since_ns;  // the last arrival; by the device
    LeastDelay delay;
  };

  static std::int64_t wrapped(std::int64_t elapsed_ns) {
    return (elapsed_ns % velodyne::kHourNs + velodyne::kHourNs) % velodyne::kHourNs;
  }
  /// Packets that a busy host held up come with the next ones; after a step all are as late.
  void notice(std::int64_t arrival_ns) {
    const std::int64_t delay = arrival_ns - running_ns_;
    if (!jump_) {
      if (std::abs(delay - usual_.get()) < kLeastJump) return;
      jump_ = {last_->arrival_ns, running_ns_, {}};
    }
    jump_->delay.add(delay, running_ns_);
    const std::int64_t by_ns = jump_->delay.get() - usual_.get();
    if (std::abs(by_ns) < kLeastJump) return jump_.reset();
    if (running_ns_ - jump_->since_ns < kCertainAfter) return;
    steps_.push_back({jump_->before_ns, by_ns});
    usual_ = jump_->delay;
    jump_.reset();
  }

  std::uint64_t packets_ = 0;
  std::int64_t first_arrival_ns_ = 0;
  bool has_times_ = false;
  std::int64_t running_ns_ = 0;  // the device's clock, on and on over the full hour
  std::optional<Packet> last_;
  LeastDelay usual_;
  std::optional<Jump> jump_;
  HostSteps steps_;
};

}  // namespace

HostSteps find_host_steps(const std::filesystem::path& capture, const LidarSettings& lidar) {
  std::optional<LidarFile> file;
  try {
    file.emplace(capture, lidar);
  } catch (const Failure&) {  // that it cannot be read is said by whoever needs it
    return {};
  }
  StepFinder finder;
  Datagram datagram;
  std::optional<std::uint32_t> sender;
  while (file->next(datagram)) {
    if (datagram.destination_port != lidar.port) continue;
    if (datagram.payload.size() != velodyne::kDataPacketSize) continue;
    if (!sender) sender = datagram.source;
    if (*sender != datagram.source) continue;
    finder.add(datagram.arrival_ns, std::int64_t{velodyne::timestamp_us(datagram.payload)} * 1000);
  }
  if (finder.has_lost_times()) {
    throw Failure(capture.string() +
                  ": all packets arrived at one time: what wrote the file has lost their times");
  }
  return finder.take();
}

void say(const HostSteps& steps) {
  for (const HostStep& step : steps) {
    fmt::print(stderr, "scree: the host's clock was set by {:+.3f} s on the way: taken out\n",
               static_cast<double>(step.by_ns) * 1e-9);
  }
}

std::int64_t SteadyTime::operator()(std::int64_t time_ns) {
  while (passed_ < steps_.size()) {
    const HostStep& step = steps_[passed_];
    // Between the time before a step ahead and that after it there is no record.
    const bool is_passed = step.by_ns > 0 ? time_ns > step.before_ns + step.by_ns / 2
                                          : last_ns_ && time_ns < *last_ns_ + step.by_ns / 2;
    if (!is_passed) break;
    set_by_ns_ += step.by_ns;
    ++passed_;
  }
  last_ns_ = time_ns;
  return time_ns - set_by_ns_;
}

}  // namespace scree::cli
