#include "decode/settings_check.hpp"

#include "commands.hpp"
#include "scree/motion/sync_buffer_of.hpp"

namespace scree::cli {

SettingsCheck::SettingsCheck(const std::filesystem::path& capture,
                             const std::filesystem::path& config, const Settings& settings,
                             const HostSteps& steps)
    : sensors_(sync_buffer_of(settings)),
      probe_(settings),
      waiting_(settings.motion_wait(), *sensors_, [this](const Sweep& sweep) {
        probe_.add(sweep, *sensors_);
        log_.add(probe_.report());
      }) {
  try {
    motion_.emplace(capture, config, settings, *sensors_, steps);
  } catch (const Failure&) {
  }
}

void SettingsCheck::play_until(std::int64_t arrival_ns) {
  now_ns_ = arrival_ns;
  if (motion_) motion_->play_until(arrival_ns);
  waiting_.process_ready(arrival_ns);
}

void SettingsCheck::add(const Sweep& sweep) {
  if (!sweep.points.empty()) waiting_.push(sweep, now_ns_);
}

std::vector<std::string> SettingsCheck::finish() {
  waiting_.process_all();
  return log_.sentences();
}

}  // namespace scree::cli
