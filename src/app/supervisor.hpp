#pragma once

#include <signal.h>

#include <chrono>
#include <functional>

#include "scree/app/daemon.hpp"

namespace scree {

/// The signals that the daemon obeys. To be made before it starts threads, which inherit that they
/// are blocked.
class Signals {
public:
  Signals();
  /// The next one of SIGTERM, SIGINT and SIGHUP, or 0 when none has come.
  int wait(std::chrono::microseconds longest) const;

private:
  sigset_t signals_{};
};

/// Serves the running daemon until SIGTERM or SIGINT comes, which it returns. Tells systemd how the
/// daemon fares, and that it is alive as long as all its threads loop. The log names a thread that
/// hangs.
/// @param reload is called at SIGHUP
int supervise(Daemon& daemon, const Signals& signals, const std::function<void()>& reload);

}  // namespace scree
