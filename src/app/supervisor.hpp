#pragma once

#include <signal.h>

#include <chrono>
#include <functional>

#include "scree/app/daemon.hpp"

namespace scree {

/// The signals that the daemon obeys, held back from now on until wait() is called, and SIGPIPE,
/// which is left alone: who reads the log may go. Threads inherit this, so it is made before them.
class Signals {
public:
  Signals();
  /// The next one of SIGTERM, SIGINT and SIGHUP, or 0 when none has come.
  int wait(std::chrono::microseconds longest) const;

private:
  sigset_t signals_{};
};

/// Serves the running daemon until SIGTERM or SIGINT comes, which it returns. It tells systemd how
/// the daemon fares, and that it is alive as long as all its threads loop. A thread that hangs
/// is named in the log.
/// @param reload is called at SIGHUP
int supervise(Daemon& daemon, const Signals& signals, const std::function<void()>& reload);

}  // namespace scree
