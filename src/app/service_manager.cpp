#include "service_manager.hpp"

#include <sys/stat.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>

namespace scree::service_manager {

void ready() {
  sd_notify(0, "READY=1");
}

void reloading() {
  const auto now = std::chrono::duration_cast<std::chrono::microseconds>(
      std::chrono::steady_clock::now().time_since_epoch());
  sd_notify(0, ("RELOADING=1\nMONOTONIC_USEC=" + std::to_string(now.count())).c_str());
}

void stopping() {
  sd_notify(0, "STOPPING=1");
}

void status(const std::string& sentence) {
  sd_notify(0, ("STATUS=" + sentence).c_str());
}

void alive() {
  sd_notify(0, "WATCHDOG=1");
}

std::optional<std::chrono::microseconds> watchdog() {
  std::uint64_t microseconds = 0;
  if (sd_watchdog_enabled(0, &microseconds) <= 0) return std::nullopt;
  return std::chrono::microseconds(microseconds);
}

bool logs_to_journal() {
  // systemd names there the socket that it has made standard error of.
  const char* journal = std::getenv("JOURNAL_STREAM");
  struct stat error {};
  if (journal == nullptr || fstat(STDERR_FILENO, &error) != 0) return false;
  return journal == std::to_string(error.st_dev) + ":" + std::to_string(error.st_ino);
}

}  // namespace scree::service_manager
