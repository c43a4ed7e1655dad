#include <signal.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>

#include "log_format.hpp"
#include "pipeline_processor.hpp"
#include "real_time.hpp"
#include "running_config.hpp"
#include "scree/app/daemon.hpp"
#include "scree/app/pipeline.hpp"
#include "scree/clock/clocks.hpp"
#include "scree/drivers/gpio/lines.hpp"
#include "service_manager.hpp"
#include "supervisor.hpp"

namespace {

enum ExitCode : int { kStopped = 0, kFailed = 1, kUsage = 2 };

int failed(const std::string& reason) {
  const char* prefix = scree::service_manager::logs_to_journal() ? "<3>" : "screed: ";
  std::istringstream lines(reason);
  for (std::string line; std::getline(lines, line);) {
    std::fprintf(stderr, "%s%s\n", prefix, line.c_str());
  }
  return kFailed;
}

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

/// Checks the configuration and all that it names; nothing is opened or started.
int check(const std::filesystem::path& file) {
  const auto config = scree::RunningConfig::read(file);
  if (!config) return failed(config.error().message);
  const auto networks = scree::load_networks(config->settings(), file);
  return networks ? kStopped : failed(networks.error().message);
}

int run(const std::filesystem::path& file) {
  auto config = scree::RunningConfig::read(file);
  if (!config) return failed(config.error().message);
  const scree::Settings& settings = config->settings();
  auto lines = scree::gpio::Lines::open(settings.gpio);  // stop is on from here
  if (!lines) return failed(lines.error().message);
  auto pipeline = scree::Pipeline::make(settings, file);
  if (!pipeline) return failed(pipeline.error().message);
  pipeline->time_stages(scree::steady_ns);

  scree::PipelineProcessor processor(*pipeline, settings.track);
  const scree::Signals signals;
  auto daemon = scree::Daemon::start(settings, std::ref(processor), &pipeline->sensors(),
                                     robot_lines(*lines));
  if (!daemon) return failed(daemon.error().message);
  scree::lock_memory();

  const int signal = scree::supervise(**daemon, signals, [&] {
    if (!config->reread()) return;
    processor.set_tracking(settings.track);
    (*daemon)->apply(settings);
  });
  spdlog::info("stopping: {}", signal == SIGINT ? "interrupted" : "asked to terminate");
  return kStopped;
}

}  // namespace

int main(int argc, char** argv) {
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
    return std::fflush(stdout) == 0 ? kStopped : failed("cannot write to standard output");
  }
  scree::set_up_log();
  try {
    return only_checks ? check(config) : run(config);
  } catch (const std::exception& error) {
    return failed(error.what());
  }
}
