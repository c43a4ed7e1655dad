#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <time.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>

#include "commands.hpp"
#include "interruption.hpp"
#include "scree/capture/capture.hpp"
#include "scree/capture/pcap_reader.hpp"
#include "scree/config/settings.hpp"
#include "scree/core/descriptor.hpp"

namespace scree::cli {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
// Between the end of a capture and its next turn: as long as between two data packets.
constexpr std::int64_t kTurnPause = 1'327'000;

struct Options {
  std::string capture, config, to = "127.0.0.1", rate = "1";
  int position_port = 0;
  bool loop = false;
};

std::int64_t monotonic_ns() {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

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

/// A socket that sends to one port, and hears from the kernel when nobody listens there.
class Port {
public:
  Port(const std::string& address, int port)
      : name_(address + ":" + std::to_string(port)), socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    if (inet_pton(AF_INET, address.c_str(), &to.sin_addr) != 1) {
      throw CLI::ValidationError("--to", "must be an IPv4 address, as in 127.0.0.1:2368");
    }
    const int on = 1;
    setsockopt(socket_.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
    if (connect(socket_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
      throw Failure("cannot send to " + name_ + ": " + std::strerror(errno));
    }
  }

  void send(std::span<const std::uint8_t> bytes) {
    if (::send(socket_.get(), bytes.data(), bytes.size(), 0) >= 0) {
      ++sent_;
    } else if (errno == ECONNREFUSED) {
      ++refused_;
    } else if (errno != EINTR) {
      throw Failure("cannot send to " + name_ + ": " + std::strerror(errno));
    }
  }

  const std::string& name() const { return name_; }
  std::uint64_t sent() const { return sent_; }
  /// The kernel tells of a datagram that nobody took only at the next one, which it does not send.
  bool is_deaf() const { return refused_ >= 25 && refused_ + 1 >= sent_; }

private:
  std::string name_;
  Descriptor socket_;
  std::uint64_t sent_ = 0, refused_ = 0;
};

/// Where the capture's datagrams go, and in which time.
class Replay {
public:
  Replay(const Options& options, const LidarSettings& lidar)
      : rate_(rate_of(options.rate)),
        captured_data_(lidar.port),
        captured_position_(lidar.position_port),
        data_(address_of(options), port_of(options, lidar.port)),
        position_(address_of(options),
                  options.position_port != 0 ? options.position_port : lidar.position_port),
        start_ns_(monotonic_ns()) {}

  /// Sends the whole capture once.
  void play(PcapReader& reader) {
    std::int64_t first = 0, last = 0;
    bool is_first = true;
    Datagram datagram;
    while (!is_interrupted() && reader.next(datagram)) {
      const bool is_data = datagram.destination_port == captured_data_;
      if (!is_data && datagram.destination_port != captured_position_) continue;
      if (is_first) first = datagram.arrival_ns;
      is_first = false;
      last = datagram.arrival_ns - first;
      if (rate_ > 0) sleep_until(turn_start_ns_ + start_ns_ + in_real_time(last));
      if (!is_interrupted()) (is_data ? data_ : position_).send(datagram.payload);
      if (data_.is_deaf()) {
        throw Failure("nobody listens on " + data_.name() + ": is screed running?");
      }
    }
    turn_start_ns_ += rate_ > 0 ? in_real_time(last + kTurnPause) : 0;
  }

  void print_summary() const {
    const double seconds = static_cast<double>(monotonic_ns() - start_ns_) / 1e9;
    std::fprintf(stderr, "sent %llu data packets to %s and %llu position packets to %s in %.2f s\n",
                 static_cast<unsigned long long>(data_.sent()), data_.name().c_str(),
                 static_cast<unsigned long long>(position_.sent()), position_.name().c_str(),
                 seconds);
  }
  const Port& data() const { return data_; }

private:
  static std::string address_of(const Options& options) {
    return options.to.substr(0, options.to.find(':'));
  }
  static int port_of(const Options& options, int otherwise) {
    const std::size_t colon = options.to.find(':');
    if (colon == std::string::npos) return otherwise;
    int port = 0;
    const char* end = options.to.data() + options.to.size();
    const auto read = std::from_chars(options.to.data() + colon + 1, end, port);
    if (read.ec != std::errc{} || read.ptr != end || port < 1 || port > 65535) {
      throw CLI::ValidationError("--to", "has no valid port after the colon");
    }
    return port;
  }
  std::int64_t in_real_time(std::int64_t captured_ns) const {
    return static_cast<std::int64_t>(static_cast<double>(captured_ns) / rate_);
  }

  double rate_;
  int captured_data_, captured_position_;
  Port data_, position_;
  std::int64_t start_ns_, turn_start_ns_ = 0;
};

void replay(const Options& options) {
  const auto file = lidar_file(options.capture);
  if (!file) throw Failure(file.error().message);
  Settings settings;
  if (const auto config = settings_file(options.capture, options.config)) {
    auto loaded = load_settings(*config);
    if (!loaded) throw Failure(loaded.error().message);
    settings = std::move(*loaded);
  }
  stop_on_signals();
  Replay replay(options, settings.lidar);
  do {
    auto reader = PcapReader::open(*file);
    if (!reader) throw Failure(reader.error().message);
    replay.play(*reader);
    if (replay.data().sent() == 0 && !is_interrupted()) {
      throw Failure(file->string() + " has no UDP datagrams to port " +
                    std::to_string(settings.lidar.port));
    }
    if (!reader->broken_off().empty()) {
      std::fprintf(stderr, "scree: %s\n", reader->broken_off().c_str());
    }
  } while (options.loop && !is_interrupted());
  replay.print_summary();
}

}  // namespace

void add_replay(CLI::App& app) {
  CLI::App* command = app.add_subcommand("replay", "Play a capture to a running daemon, over UDP");
  auto options = std::make_shared<Options>();
  command->add_option("capture", options->capture, "capture to play")
      ->required()
      ->type_name("CAPTURE");
  command->add_option("--rate", options->rate, "times real time; 0 or max: as fast as possible [1]")
      ->type_name("X");
  command->add_flag("--loop", options->loop, "begin anew at the end, until interrupted");
  command
      ->add_option("--to", options->to, "where the daemon listens [127.0.0.1, the capture's port]")
      ->type_name("ADDRESS[:PORT]");
  command
      ->add_option("--position-port", options->position_port,
                   "port for position packets [the capture's]")
      ->check(CLI::Range(1, 65535));
  command
      ->add_option("--config", options->config,
                   "configuration that names the capture's ports [scree.toml in the capture]")
      ->type_name("FILE");
  command->callback([options] { replay(*options); });
}

}  // namespace scree::cli
