#pragma once

#include <chrono>
#include <optional>
#include <string>

/// What systemd is told of the service; nothing happens where it has not started this program.
namespace scree::service_manager {

void ready();
/// Followed by ready() when the configuration was read again.
void reloading();
void stopping();
/// One sentence, for `systemctl status`.
void status(const std::string& sentence);
/// All threads loop.
void alive();

/// The time after which systemd restarts the process when it has not called alive(); nothing where
/// systemd does not watch.
std::optional<std::chrono::microseconds> watchdog();

/// Whether standard error goes to the journal, which stamps lines itself and takes their level from
/// a prefix <0> to <7>.
bool logs_to_journal();

}  // namespace scree::service_manager
