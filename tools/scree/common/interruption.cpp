#include "common/interruption.hpp"

#include <signal.h>

namespace scree::cli {
namespace {

volatile sig_atomic_t interrupted = 0;

}  // namespace

void stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted = 1; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A terminal that goes, unless whoever started this wants it to go on (nohup).
  struct sigaction of_terminal {};
  sigaction(SIGHUP, nullptr, &of_terminal);
  if (of_terminal.sa_handler == SIG_DFL) sigaction(SIGHUP, &action, nullptr);
}

bool is_interrupted() {
  return interrupted != 0;
}

}  // namespace scree::cli
