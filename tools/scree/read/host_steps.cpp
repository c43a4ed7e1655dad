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
      if (const auto elapsed = elapsed_since(*last_, arrival_ns, device_ns)) {
        running_ns_ += *elapsed;
        notice(arrival_ns);
      } else {
        begin_anew(arrival_ns);
      }
    }
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
      if (by_ns < 0 || by_ns > kLongestDelay) {
        steps_.push_back({jump_->before_ns, jump_->after_ns, by_ns});
      }
    }
    return std::move(steps_);
  }

private:
  static constexpr std::int64_t kLongestPause = 60 * kSecond;
  static constexpr std::int64_t kShortPause = 500 * kMillisecond;
  static constexpr std::int64_t kLeastJump = 30 * kMillisecond;
  static constexpr std::int64_t kCertainAfter = 300 * kMillisecond;

  struct Packet {
    std::int64_t arrival_ns, device_ns;
  };
  struct Jump {
    std::int64_t before_ns, after_ns;  // the arrivals on either side
    std::int64_t since_ns;             // by the device
    LeastDelay delay;
  };

  static std::int64_t wrapped(std::int64_t elapsed_ns) {
    return (elapsed_ns % velodyne::kHourNs + velodyne::kHourNs) % velodyne::kHourNs;
  }
  /// How much time went by for the device; nothing where it has started anew, or one packet has
  /// overtaken another.
  static std::optional<std::int64_t> elapsed_since(const Packet& last, std::int64_t arrival_ns,
                                                   std::int64_t device_ns) {
    const std::int64_t elapsed = wrapped(device_ns - last.device_ns);
    if (elapsed == 0 || elapsed > kLongestPause) return std::nullopt;
    const std::int64_t pause_ns = arrival_ns - last.arrival_ns, by_ns = pause_ns - elapsed;
    if (elapsed <= kShortPause) return elapsed;
    // Its clock was set, for one by GPS, while the packets went on.
    constexpr std::int64_t kNoPause = 20 * kMillisecond;
    if (pause_ns >= 0 && pause_ns < kNoPause) return std::nullopt;
    // In a pause its clock may have gone round: no step is taken for whole hours ahead.
    if (by_ns <= 0) return elapsed;
    return elapsed + (by_ns + velodyne::kHourNs / 2) / velodyne::kHourNs * velodyne::kHourNs;
  }
  /// A device that was away or has started anew says nothing. Only that no time runs back.
  void begin_anew(std::int64_t arrival_ns) {
    constexpr std::int64_t kBack = 100 * kMillisecond;
    const std::int64_t by_ns = arrival_ns - last_->arrival_ns;
    if (by_ns < -kBack) steps_.push_back({last_->arrival_ns, arrival_ns, by_ns});
    jump_.reset();
    usual_ = {};
  }
  /// Packets that a busy host held up come with the next ones; after a step all are as late.
  void notice(std::int64_t arrival_ns) {
    const std::int64_t delay = arrival_ns - running_ns_;
    if (!jump_) {
      if (std::abs(delay - usual_.get()) < kLeastJump) return;
      jump_ = {last_->arrival_ns, arrival_ns, running_ns_, {}};
    }
    jump_->delay.add(delay, running_ns_);
    const std::int64_t by_ns = jump_->delay.get() - usual_.get();
    if (std::abs(by_ns) < kLeastJump) return jump_.reset();
    if (running_ns_ - jump_->since_ns < kCertainAfter) return;
    steps_.push_back({jump_->before_ns, jump_->after_ns, by_ns});
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
    // A step shows itself in each file as a jump, unless nothing was written meanwhile.
    const std::int64_t jump = last_ns_ ? time_ns - *last_ns_ : 0;
    const std::int64_t lidar_jump = step.after_ns - step.before_ns;
    const bool jumps = step.by_ns > 0 ? time_ns > step.before_ns && jump > step.by_ns / 2
                                      : jump < std::max(step.by_ns, lidar_jump) / 2;
    const bool is_passed = jumps || (lidar_jump > 0 && time_ns >= step.after_ns);
    if (!is_passed) break;
    set_by_ns_ += step.by_ns;
    ++passed_;
  }
  last_ns_ = time_ns;
  return time_ns - set_by_ns_;
}

}  // namespace scree::cli
