#include <signal.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "scree/app/daemon.hpp"
#include "scree/app/pipeline.hpp"
#include "scree/drivers/encoder/dbc.hpp"
#include "scree/drivers/gpio/lines.hpp"

namespace {

enum ExitCode : int { kStopped = 0, kFailed = 1, kUsage = 2 };

int failed(const std::string& reason) {
  std::fprintf(stderr, "screed: %s\n", reason.c_str());
  return kFailed;
}

scree::Process process_of(scree::Pipeline& pipeline) {
  return [&pipeline, all = scree::Dropped()](
             const scree::Sweep& sweep,
             scree::Dropped& dropped) mutable -> const scree::ObstacleList& {
    const scree::ObstacleList& list = pipeline.process(sweep);
    const scree::StageCounts counts = pipeline.counts();
    all.points += counts.dropped;
    all.edge_points += counts.edges_dropped;
    all.obstacles += counts.obstacles_dropped;
    all.map_points = pipeline.mapper().map().dropped();
    all.tracks = pipeline.tracker().dropped();
    dropped = all;
    return list;
  };
}

/// Valid as long as the lines are held.
scree::RobotLines robot_lines(scree::gpio::Lines& held) {
  const auto setter = [](std::optional<scree::gpio::Output>& line) -> scree::RobotLines::Set {
    if (!line) return {};
    return [&line](bool is_on) { return line->set(is_on); };
  };
  scree::RobotLines lines{setter(held.stop), setter(held.heartbeat), {}};
  if (held.pps) {
    lines.pps = {held.pps->descriptor(), [&pps = *held.pps] { return pps.read(); }};
  }
  return lines;
}

int run(const std::filesystem::path& config) {
  auto settings = scree::load_settings(config);
  if (!settings) return failed(settings.error().message);
  const auto encoder = scree::encoder::with_dbc(settings->encoder, config.parent_path());
  if (!encoder) return failed(encoder.error().message);
  settings->encoder = *encoder;
  auto lines = scree::gpio::Lines::open(settings->gpio);  // stop is on from here
  if (!lines) return failed(lines.error().message);
  auto pipeline = scree::Pipeline::make(*settings, config.parent_path());
  if (!pipeline) return failed(pipeline.error().message);

  sigset_t stop_signals;
  sigemptyset(&stop_signals);
  sigaddset(&stop_signals, SIGTERM);
  sigaddset(&stop_signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &stop_signals, nullptr);
  auto daemon = scree::Daemon::start(*settings, process_of(*pipeline), &pipeline->sensors(),
                                     robot_lines(*lines));
  if (!daemon) return failed(daemon.error().message);

  int signal = 0;
  sigwait(&stop_signals, &signal);
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
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kStopped : kUsage;
  }
  // The journal has its own time stamps, people at a terminal do not.
  spdlog::set_default_logger(spdlog::stderr_logger_mt("screed"));
  spdlog::set_pattern("%H:%M:%S.%e %l: %v");
  spdlog::flush_on(spdlog::level::info);
  try {
    return run(config);
  } catch (const std::exception& error) {
    return failed(error.what());
  }
}
