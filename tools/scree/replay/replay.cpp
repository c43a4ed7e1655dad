#include <spdlog/fmt/fmt.h>
#include <time.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "common/interruption.hpp"
#include "common/progress.hpp"
#include "common/time_range.hpp"
#include "read/capture_events.hpp"
#include "read/lidar_capture.hpp"
#include "replay/imu_terminal.hpp"
#include "replay/udp_target.hpp"
#include "scree/core/nanoseconds.hpp"
#include "scree/drivers/encoder/can_sender.hpp"

namespace scree::cli {
namespace {

// Between the end of a capture and its next turn: as long as between two data packets.
constexpr std::int64_t kTurnPause = 1'327'000;

struct ReplayOptions {
  std::string capture, config, address = "127.0.0.1", rate = "1", serial, can;
  int position_port = 0;
  TimeRange range;
  bool loop = false;
};

void sleep_until(std::int64_t due_ns) {
  const timespec due{due_ns / kSecond, due_ns % kSecond};
  while (!is_interrupted() &&
         clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
  }
}

/// 0 for as fast as possible.
double rate_of(const std::string& text) {
  if (text == "max") return 0;
  double rate = -1;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, rate);
  if (read.ec != std::errc{} || read.ptr != end || !(rate >= 0 && rate <= 1000)) {
    throw CLI::ValidationError("--rate", "must be a number from 0 to 1000, or max");
  }
  return rate;
}

UdpTarget target(const ReplayOptions& options, int port) {
  return {options.address.substr(0, options.address.find(':')), port};
}

int data_port(const ReplayOptions& options, int otherwise) {
  const std::size_t colon = options.address.find(':');
  if (colon == std::string::npos) return otherwise;
  int port = 0;
  const char* end = options.address.data() + options.address.size();
  const auto read = std::from_chars(options.address.data() + colon + 1, end, port);
  if (read.ec != std::errc{} || read.ptr != end || port < 1 || port > 65535) {
    throw CLI::ValidationError("--address", "has no valid port after the colon");
  }
  return port;
}

/// The encoder's bus, and what became of the frames.
struct CanTarget {
  explicit CanTarget(const std::string& interface)
      : name(interface),
        // Errors were never on a real bus; a virtual one shows them to whoever listens.
        takes_errors(std::filesystem::exists("/sys/devices/virtual/net/" + interface)),
        sender(value_or_fail(encoder::CanSender::open(interface))) {}

  void send(const CanFrame& frame) {
    if (frame.is_error && !takes_errors) return;
    const int error = sender.send(frame);
    ++(error == 0 ? sent : lost);
    if (error != 0) reason = std::strerror(error);
  }

  std::string name, reason;
  bool takes_errors;
  encoder::CanSender sender;
  std::uint64_t sent = 0, lost = 0;
};

/// Where a capture goes, and in which time.
class Replay {
public:
  Replay(const ReplayOptions& options, const LidarSettings& lidar)
      : rate_(rate_of(options.rate)),
        range_(options.range),
        captured_data_(lidar.port),
        captured_position_(lidar.position_port),
        data_(target(options, data_port(options, lidar.port))),
        position_(target(
            options, options.position_port != 0 ? options.position_port : lidar.position_port)) {
    if (!options.can.empty()) can_.emplace(options.can);
    if (!options.serial.empty()) imu_.emplace(options.serial);
  }

  /// Until the program that listens to the IMU has started it. Throws Failure where none comes.
  void wait_for_listener() {
    if (!imu_) return;
    fmt::print(stderr, "scree: the IMU is {}, waiting for screed to open it\n", imu_->name());
    constexpr std::int64_t kPatience = 20 * kSecond, kConfigures = kSecond;
    const std::int64_t begin = read_clock(CLOCK_MONOTONIC);
    std::int64_t opened_ns = 0;
    while (!is_interrupted()) {
      imu_->serve(kSecond / 50);
      const std::int64_t now = read_clock(CLOCK_MONOTONIC);
      if (!imu_->is_open()) {
        opened_ns = 0;
        if (now - begin > kPatience) {
          throw Failure(fmt::format("nobody opens {}: does screed run, with imu.device = \"{}\"?",
                                    imu_->name(), imu_->name()));
        }
        continue;
      }
      if (opened_ns == 0) opened_ns = now;
      // Who does not configure it takes what it sends.
      const bool is_due = imu_->was_configured() || now - opened_ns > kConfigures;
      if (is_due && imu_->is_listened_to()) return;
    }
  }

  /// Sends the whole range once. @param span_ns from the capture's first arrival to its last, for
  /// the progress; 0: unknown
  void play(CaptureEvents& events, std::int64_t span_ns) {
    if (start_ns_ == 0) start_ns_ = turn_start_ns_ = read_clock(CLOCK_MONOTONIC);
    const std::int64_t length = std::min(span_ns, range_.end_ns()) - range_.begin_ns();
    std::optional<Progress> progress;
    if (span_ns > 0) progress.emplace("playing", static_cast<std::size_t>(length));
    std::int64_t first_ns = 0, last = 0;
    CaptureEvent event;
    for (bool is_first = true; !is_interrupted() && events.next(event); is_first = false) {
      if (is_first) first_ns = event.arrival_ns;
      const std::int64_t since_start = event.arrival_ns - first_ns;
      if (since_start >= range_.end_ns()) break;
      if (since_start < range_.begin_ns()) continue;
      last = since_start - range_.begin_ns();
      wait_until(rate_ > 0 ? turn_start_ns_ + in_real_time(last) : 0);
      if (!is_interrupted()) send(event);
      if (progress) (*progress)(static_cast<std::size_t>(last));
    }
    turn_start_ns_ += rate_ > 0 ? in_real_time(last + kTurnPause) : 0;
  }

  /// Until what was sent last is read: with the terminal it would be lost.
  void finish() {
    if (!imu_) return;
    const std::int64_t end = read_clock(CLOCK_MONOTONIC) + kSecond / 5;
    for (std::int64_t now = 0; (now = read_clock(CLOCK_MONOTONIC)) < end;) imu_->serve(end - now);
  }

  /// Whether anything of the lidar was sent.
  bool has_sent() const { return data_.sent() + position_.sent() > 0; }

  void print_summary() const {
    const double seconds = static_cast<double>(read_clock(CLOCK_MONOTONIC) - start_ns_) / 1e9;
    std::string text = fmt::format("sent {} data packets to {} and {} position packets to {}",
                                   data_.sent(), data_.name(), position_.sent(), position_.name());
    if (imu_) text += fmt::format(", {} reads of the IMU to {}", imu_->sent(), imu_->name());
    if (can_) text += fmt::format(", {} frames to {}", can_->sent, can_->name);
    fmt::print(stderr, "{} in {:.2f} s\n", text, seconds);
    if (imu_ && imu_->lost() > 0) {
      fmt::print(stderr, "scree: {} reads of the IMU were not taken\n", imu_->lost());
    }
    if (can_ && can_->lost > 0) {
      fmt::print(stderr, "scree: {} frames were not taken: {}\n", can_->lost, can_->reason);
    }
  }

private:
  void wait_until(std::int64_t due_ns) {
    if (!imu_) return sleep_until(due_ns);
    do {
      imu_->serve(due_ns - read_clock(CLOCK_MONOTONIC));
    } while (!is_interrupted() && read_clock(CLOCK_MONOTONIC) < due_ns);
  }

  void send(const CaptureEvent& event) {
    switch (event.sensor) {
      case Sensor::lidar:
        if (event.port == captured_data_) data_.send(event.bytes);
        if (event.port == captured_position_) position_.send(event.bytes);
        if (data_.is_deaf()) {
          throw Failure("nobody listens on " + data_.name() + ": is screed running?");
        }
        break;
      case Sensor::imu:
        if (imu_) imu_->send(event.bytes);
        break;
      case Sensor::encoder:
        if (can_) can_->send(event.frame);
        break;
    }
  }

  std::int64_t in_real_time(std::int64_t captured_ns) const {
    return static_cast<std::int64_t>(static_cast<double>(captured_ns) / rate_);
  }

  double rate_;
  TimeRange range_;
  int captured_data_, captured_position_;
  UdpTarget data_, position_;
  std::optional<CanTarget> can_;
  std::optional<ImuTerminal> imu_;
  std::int64_t start_ns_ = 0, turn_start_ns_ = 0;
};

/// Says what the capture has and nobody gets.
void say_what_is_left_out(const CaptureEvents& events, const ReplayOptions& options) {
  if (events.has_imu() && options.serial.empty()) {
    fmt::print(stderr, "scree: the IMU is not played: --serial names a port for it\n");
  }
  if (events.has_encoder() && options.can.empty()) {
    fmt::print(stderr, "scree: the encoder is not played: --can names an interface for it\n");
  }
}

std::string nothing_sent(const ReplayOptions& options, const Settings& settings) {
  const auto [first_ns, last_ns] = span_of(options.capture, settings);
  if (options.range.begin_ns() > last_ns - first_ns) {
    return options.range.nothing_in(options.capture, last_ns - first_ns);
  }
  return fmt::format("{} has no UDP datagrams to port {} in that time", options.capture,
                     settings.lidar.port);
}

void replay(const ReplayOptions& options) {
  options.range.check();
  const Settings settings = capture_settings(options.capture, options.config);
  stop_on_signals();
  Replay replay(options, settings.lidar);
  std::int64_t span_ns = 0;
  if (Progress::is_shown()) {
    const auto [first_ns, last_ns] = span_of(options.capture, settings);
    span_ns = last_ns - first_ns;
  }
  for (bool is_first = true; is_first || (options.loop && !is_interrupted()); is_first = false) {
    CaptureEvents events(options.capture, settings);
    if (is_first) {
      say_what_is_left_out(events, options);
      replay.wait_for_listener();
    }
    replay.play(events, span_ns);
    if (!replay.has_sent() && !is_interrupted()) throw Failure(nothing_sent(options, settings));
    if (!events.broken_off().empty()) fmt::print(stderr, "scree: {}\n", events.broken_off());
  }
  replay.finish();
  replay.print_summary();
}

}  // namespace

void add_replay(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("replay", "Play a capture to a running daemon: UDP, serial, CAN");
  auto options = std::make_shared<ReplayOptions>();
  command->add_option("capture", options->capture, "capture to play")
      ->required()
      ->type_name("CAPTURE");
  command
      ->add_option("--address", options->address,
                   "where the daemon listens [127.0.0.1, the capture's port]")
      ->type_name("ADDRESS[:PORT]");
  command
      ->add_option("--position-port", options->position_port,
                   "port for position packets [the capture's]")
      ->check(CLI::Range(1, 65535));
  command
      ->add_option("--serial", options->serial,
                   "play the IMU on a pseudo-terminal with this name, the daemon's imu.device")
      ->type_name("PATH");
  command
      ->add_option("--can", options->can,
                   "play the encoder on this CAN interface, the daemon's encoder.interface")
      ->type_name("INTERFACE");
  command
      ->add_option("--rate", options->rate,
                   "times real time; 0 or max: as fast as possible; below 1 the daemon finds "
                   "its data old, and says BLIND [1]")
      ->type_name("X");
  options->range.add_to(*command);
  command->add_flag("--loop", options->loop, "begin anew at the end, until interrupted");
  command
      ->add_option("--config", options->config,
                   "configuration that names the capture's ports [scree.toml in the capture]")
      ->type_name("FILE");
  command->callback([options] { replay(*options); });
}

}  // namespace scree::cli
