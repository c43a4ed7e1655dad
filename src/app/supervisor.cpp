#include "supervisor.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>

#include "service_manager.hpp"

namespace scree {
namespace {

using std::chrono::microseconds;
using Clock = std::chrono::steady_clock;

/// Looks after the threads, and tells systemd when all go round.
class Watch {
public:
  explicit Watch(Daemon& daemon) : daemon_(daemon) {}

  microseconds pause() const { return limit_ / 4; }

  void look() {
    const std::string_view missing = daemon_.missing_thread();
    if (missing.empty()) {
      service_manager::alive();
      if (has_said_) spdlog::info("all threads go round again");
      has_said_ = false;
      alive_at_ = Clock::now();
    } else if (!has_said_ && Clock::now() - alive_at_ > limit_ / 2) {
      spdlog::error("the {} thread hangs", missing);
      has_said_ = true;
    }
  }

private:
  Daemon& daemon_;
  microseconds limit_ = service_manager::watchdog().value_or(std::chrono::seconds(4));
  Clock::time_point alive_at_ = Clock::now();
  bool has_said_ = false;
};

}  // namespace

Signals::Signals() {
  sigemptyset(&signals_);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals_, signal);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

int Signals::wait(microseconds longest) const {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(longest);
  const std::chrono::nanoseconds rest = longest - seconds;
  const timespec time{seconds.count(), rest.count()};
  return std::max(sigtimedwait(&signals_, nullptr, &time), 0);
}

int supervise(Daemon& daemon, const Signals& signals, const std::function<void()>& reload) {
  Watch watch(daemon);
  std::string said;
  service_manager::ready();
  while (true) {
    const int signal = signals.wait(watch.pause());
    if (signal == SIGHUP) {
      service_manager::reloading();
      reload();
      service_manager::ready();
    } else if (signal != 0) {
      service_manager::stopping();
      return signal;
    }
    watch.look();
    const std::string status = daemon.status();
    if (status != said) service_manager::status(status);
    said = status;
  }
}

}  // namespace scree
