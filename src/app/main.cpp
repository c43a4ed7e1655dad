#include <signal.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <new>
#include <string>

#include "log_format.hpp"
#include "pipeline_processor.hpp"
#include "real_time.hpp"
#include "running_config.hpp"
#include "scree/app/daemon.hpp"
#include "scree/app/memory_cap.hpp"
#include "scree/app/pipeline.hpp"
#include "scree/clock/clocks.hpp"
#include "scree/drivers/gpio/lines.hpp"
#include "scree/drivers/velodyne/udp_receiver.hpp"
#include "service_manager.hpp"
#include "supervisor.hpp"

namespace {

enum ExitCode : int { kStopped = 0, kFailed = 1, kUsage = 2 };

/// The result is valid as long as the lines are held.
scree::RobotLines robot_lines(scree::gpio::Lines& held) {
  const auto setter = [](std::optional<scree::gpio::Output>& line) -> scree::RobotLines::Set {
    if (!line) return {};
    return [&line](bool is_on) { return line->set(is_on); };
  };
  scree::RobotLines lines{setter(held.stop), setter(held.heartbeat), {}};
  if (held.pps) {
    scree::gpio::PulseInput& pps = *held.pps;
    lines.pps = {[&pps] { return pps.descriptor(); }, [&pps] { return pps.read(); },
                 [&pps] { pps.close(); }};
  }
  return lines;
}

/// Checks the configuration, all that it names, and that this computer has it; nothing is started.
scree::Result<void> check(const std::filesystem::path& file) {
  const auto config = scree::RunningConfig::read(file);
  if (!config) return tl::make_unexpected(config.error());
  const scree::Settings& settings = config->settings();
  const auto networks = scree::load_networks(settings, file);
  if (!networks) return tl::make_unexpected(networks.error());
  const auto lines = scree::gpio::check_lines(settings.gpio);
  return lines ? scree::check_interface(settings.lidar.address) : lines;
}

scree::Result<void> run(const std::filesystem::path& file, const scree::Signals& signals) {
  auto config = scree::RunningConfig::read(file);
  if (!config) return tl::make_unexpected(config.error());
  const scree::Settings& settings = config->settings();
  auto lines = scree::gpio::Lines::open(settings.gpio);  // stop is on from here
  if (!lines) return tl::make_unexpected(lines.error());
  const std::uint64_t taken_before = scree::memory_taken();
  auto pipeline = scree::within_memory([&] { return scree::Pipeline::make(settings, file); });
  if (!pipeline) return tl::make_unexpected(pipeline.error());
  spdlog::info("map and detector take {:.2f} GB of memory",
               static_cast<double>(scree::memory_taken() - taken_before) * 1e-9);
  pipeline->time_stages(scree::steady_ns);

  scree::PipelineProcessor processor(*pipeline, settings.track);
  auto daemon = scree::Daemon::start(settings, std::ref(processor), &pipeline->sensors(),
                                     robot_lines(*lines));
  if (!daemon) return tl::make_unexpected(daemon.error());
  scree::lock_memory();

  const int signal = scree::supervise(**daemon, signals, [&] {
    if (!config->reread()) return;
    processor.set_tracking(settings.track);
    (*daemon)->apply(settings);
  });
  spdlog::info("stopping: {}", signal == SIGINT ? "interrupted" : "asked to terminate");
  return {};
}

/// @param work what the options ask for
int ended(const std::function<scree::Result<void>()>& work) {
  scree::Log log;
  try {
    const auto done = work();
    if (!done) log.failed(done.error().message);
    return done ? kStopped : kFailed;
  } catch (const std::bad_alloc&) {
    log.failed("there is not enough memory (`ulimit -v`, `free -m`)");
  } catch (const std::exception& error) {
    log.failed(error.what());
  }
  return kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  scree::make_stacks_small();
  const scree::Signals signals;  // asked to end while it starts, it ends as soon as it has
  CLI::App app("Finds obstacles in a lidar's data and publishes them on LCM");
  app.name("screed");
  app.set_version_flag("--version", SCREE_VERSION);
  std::string config = "/etc/scree/scree.toml";
  app.add_option("--config", config, "configuration file")
      ->type_name("FILE")
      ->capture_default_str();
  bool only_checks = false;
  app.add_flag("--check-config", only_checks,
               "check the configuration and end: 0 when it is right");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (app.exit(error) != 0) return kUsage;
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return kStopped;
    std::fputs("screed: cannot write to standard output\n", stderr);
    return kFailed;
  }
  return ended([&] { return only_checks ? check(config) : run(config, signals); });
}
