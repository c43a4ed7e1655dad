#include "record/record.hpp"

#include <poll.h>
#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "common/interruption.hpp"
#include "record/new_capture.hpp"
#include "record/recorders.hpp"
#include "scree/drivers/encoder/dbc.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kLookMs = 50;  // how often sensors that are missing, and the time, are looked after

struct RecordOptions {
  std::string folder, config = kConfigOfRobot;
  double seconds = 0;
  Outputs outputs;
};

/// What is told on stderr: each problem once, how far it is where stderr is a terminal, and the
/// sum.
class Report {
public:
  explicit Report(const std::vector<Recorder*>& recorders)
      : recorders_(recorders), said_(recorders.size()) {}

  void update(double seconds) {
    if (!is_read()) return;
    for (std::size_t i = 0; i < recorders_.size(); ++i) {
      if (recorders_[i]->problem() == said_[i]) continue;
      said_[i] = recorders_[i]->problem();
      if (!said_[i].empty()) fmt::print(stderr, "{}scree: {}\n", kClear, said_[i]);
    }
    constexpr double kPause = 0.5;
    if (!is_terminal_ || seconds - shown_at_ < kPause) return;
    shown_at_ = seconds;
    fmt::print(stderr, "{}{}", kClear, line(seconds));
  }
  void end(double seconds) const {
    if (is_read()) fmt::print(stderr, "{}{}\n", kClear, line(seconds));
  }

private:
  /// Whoever reads stderr may stop to (Ctrl-S): the recording must not wait for it.
  static bool is_read() {
    pollfd wait_for{STDERR_FILENO, POLLOUT, 0};
    return poll(&wait_for, 1, 0) == 1 && (wait_for.revents & (POLLOUT | POLLERR)) == POLLOUT;
  }
  std::string line(double seconds) const {
    std::string text = fmt::format("recorded {:.1f} s", seconds);
    for (const Recorder* recorder : recorders_) text += "; " + recorder->progress();
    return text;
  }

  const bool is_terminal_ = isatty(STDERR_FILENO) != 0;
  const char* const kClear = is_terminal_ ? "\r\033[K" : "";
  std::vector<Recorder*> recorders_;
  std::vector<std::string> said_;
  double shown_at_ = 0;
};

/// Until the time is over (0: never) or a signal comes. @return seconds
double run(const std::vector<Recorder*>& recorders, double longest, Report& report) {
  const auto start = Clock::now();
  std::vector<pollfd> wait_for;
  while (true) {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - start).count();
    for (Recorder* recorder : recorders) {
      recorder->work(std::chrono::nanoseconds(now.time_since_epoch()).count());
    }
    report.update(seconds);
    if (is_interrupted() || (longest > 0 && seconds >= longest)) return seconds;
    wait_for.clear();
    for (const Recorder* recorder : recorders) recorder->add_descriptors(wait_for);
    poll(wait_for.data(), wait_for.size(), kLookMs);
  }
}

}  // namespace

void record_sensors(const fs::path& config, const fs::path& folder, double seconds,
                    const Outputs& outputs) {
  stop_on_signals();
  std::signal(SIGPIPE, SIG_IGN);  // whoever reads stderr may go
  const Settings settings = value_or_fail(load_settings(config));
  value_or_fail(encoder::with_dbc(settings.encoder, config));
  HostClock clock;
  LidarRecorder lidar(settings.lidar, clock);
  make_capture_folder(folder, outputs, config);
  keep_config(config, folder);
  lidar.create(folder / "lidar.pcap");
  std::optional<ImuRecorder> imu;
  if (!settings.imu.device.empty()) imu.emplace(settings.imu, folder / "imu.pcap", clock);
  std::optional<CanRecorder> can;
  if (!settings.encoder.interface.empty()) {
    can.emplace(settings.encoder.interface, folder / "can.log", clock);
  }

  fmt::print(stderr, "scree: recording to {}\n", folder.string());
  std::vector<Recorder*> recorders = {&lidar};
  if (imu) recorders.push_back(&*imu);
  if (can) recorders.push_back(&*can);
  Report report(recorders);
  const double recorded = run(recorders, seconds, report);
  for (Recorder* recorder : recorders) recorder->close();
  report.end(recorded);
  if (std::all_of(recorders.begin(), recorders.end(),
                  [](const Recorder* recorder) { return recorder->count() == 0; })) {
    throw Failure("nothing came from any sensor");
  }
}

void add_record(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("record", "Record the live sensors into a capture, instead of screed");
  const auto options = std::make_shared<RecordOptions>();
  command->add_option("folder", options->folder, "new folder of the capture")
      ->required()
      ->type_name("DIR");
  command->add_option("--config", options->config, "configuration that names the sensors")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "end after this time, else when interrupted")
      ->check(CLI::PositiveNumber);
  options->outputs.add_to(*command);
  command->callback([options] {
    record_sensors(options->config, options->folder, options->seconds, options->outputs);
  });
}

}  // namespace scree::cli
