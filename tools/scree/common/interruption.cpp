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
}

bool is_interrupted() {
  return interrupted != 0;
}

}  // namespace scree::cli
