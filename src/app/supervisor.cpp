#include "supervisor.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <csignal>
#include <string>

#include "service_manager.hpp"

namespace scree {
namespace {

using std::chrono::microseconds;
using Clock = std::chrono::steady_clock;

/// Feeds systemd's watchdog while no thread of the daemon is stalled.
class WatchdogFeeder {
public:
  explicit WatchdogFeeder(Daemon& daemon) : daemon_(daemon) {}

  /// Often enough that one check may fail without systemd ending the process.
  microseconds interval() const { return limit_ / 4; }

  void check() {
    const std::string_view stalled = daemon_.stalled_thread();
    if (stalled.empty()) {
      service_manager::alive();
      if (is_logged_) spdlog::info("all threads go round again");
      is_logged_ = false;
      alive_at_ = Clock::now();
    } else if (!is_logged_ && Clock::now() - alive_at_ > limit_ / 2) {
      spdlog::error("the {} thread hangs", stalled);
      is_logged_ = true;
    }
  }

private:
  // Where systemd does not watch, the log still names a thread that hangs for two seconds.
  static constexpr std::chrono::seconds kLimitWithoutSystemd{4};

  Daemon& daemon_;
  microseconds limit_ = service_manager::watchdog().value_or(kLimitWithoutSystemd);
  Clock::time_point alive_at_ = Clock::now();
  bool is_logged_ = false;
};

}  // namespace

Signals::Signals() {
  sigemptyset(&signals_);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals_, signal);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

int Signals::wait(microseconds longest) const {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(longest);
  const std::chrono::nanoseconds rest = longest - seconds;
  const timespec time{seconds.count(), rest.count()};
  return std::max(sigtimedwait(&signals_, nullptr, &time), 0);
}

int supervise(Daemon& daemon, const Signals& signals, const std::function<void()>& reload) {
  WatchdogFeeder watchdog(daemon);
  std::string told;
  service_manager::ready();
  while (true) {
    const int signal = signals.wait(watchdog.interval());
    if (signal == SIGHUP) {
      service_manager::reloading();
      reload();
      service_manager::ready();
    } else if (signal != 0) {
      service_manager::stopping();
      return signal;
    }
    watchdog.check();
    const std::string status = daemon.status();
    if (status != told) service_manager::status(status);
    told = status;
  }
}

}  // namespace scree
