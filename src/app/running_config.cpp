#include "running_config.hpp"

#include <spdlog/fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <utility>
#include <vector>

#include "scree/config/configuration.hpp"
#include "scree/config/reload.hpp"
#include "scree/drivers/encoder/dbc.hpp"
#include "scree/drivers/gpio/lines.hpp"
#include "scree/drivers/velodyne/udp_receiver.hpp"
#include "scree/drivers/xsens/start_up.hpp"
#include "scree/publish/multicast.hpp"

namespace scree {
namespace {

/// LCM knows urls that lead to no other process.
Result<void> check_planner_url(const std::string& url) {
  if (!url.starts_with("memq://") && !url.starts_with("file://")) return check_lcm_url(url);
  return fail("at the LCM url " + url + " no planner hears: udpm://239.255.76.67:7667?ttl=0");
}

namespace fs = std::filesystem;

/// Of a folder that screed makes: what there is of its path must be a folder.
Result<void> check_folder(const fs::path& folder) {
  std::error_code none;
  fs::path there = folder;
  while (!there.empty() && !fs::exists(there, none) && there != there.parent_path()) {
    there = there.parent_path();
  }
  if (folder.empty() || fs::is_directory(there, none)) return {};
  return fail(there.string() + " is no folder");
}

/// Of a file whose place a new one takes again and again: a device would be gone.
Result<void> check_replaced_file(const fs::path& file) {
  std::error_code none;
  if (file.empty()) return {};
  if (fs::exists(file, none) && !fs::is_regular_file(file, none)) {
    return fail(file.string() + " is no plain file");
  }
  if (fs::is_directory(file.parent_path(), none)) return {};
  return fail("there is no folder " + file.parent_path().string());
}

std::vector<KeyMistake> unusable(const Configuration& configuration) {
  const Settings& settings = configuration.settings;
  std::vector<KeyMistake> found;
  const auto judge = [&](const char* key, const auto& result) {
    if (!result) found.push_back({key, result.error().message});
  };
  judge("lidar.address", local_address(settings.lidar.address));
  judge("lidar.sender", sender_address(settings.lidar.sender));
  if (const auto reason = xsens::line_too_slow(settings.imu))
    found.push_back({"imu.baud", *reason});
  judge("gpio.pps", gpio::check_name(settings.gpio.pps));
  judge("gpio.stop", gpio::check_name(settings.gpio.stop));
  judge("gpio.heartbeat", gpio::check_name(settings.gpio.heartbeat));
  judge("lcm.url", check_planner_url(settings.lcm.url));
  judge("blackbox.folder", check_folder(settings.blackbox.folder));
  judge("metrics.file", check_replaced_file(settings.metrics.file));
  return found;
}

/// What the DBC file has wrong; that it is not there is said anyway.
std::vector<KeyMistake> unusable_signal(const EncoderSettings& settings,
                                        const std::filesystem::path& file) {
  const bool has_both = !settings.dbc.empty() && !settings.signal.empty();
  if (!has_both || !find_file(settings.dbc, file)) return {};
  const auto encoder = encoder::with_dbc(settings, file);
  if (encoder) return {};
  return {{"encoder.signal", encoder.error().message}};
}

std::string in_one_line(const std::string& lines) {
  std::string line;
  for (const char c : lines) line += c == '\n' ? "; " : std::string(1, c);
  return line;
}

}  // namespace

RunningConfig::RunningConfig(std::filesystem::path file, const Settings& written,
                             const Settings& settings)
    : file_(std::move(file)), written_(written), settings_(settings) {}

Result<RunningConfig> RunningConfig::read(const std::filesystem::path& file) {
  const auto judge = [&file](const Configuration& configuration) {
    std::vector<KeyMistake> found = unusable(configuration);
    for (auto& mistake : unusable_signal(configuration.settings.encoder, file)) {
      found.push_back(std::move(mistake));
    }
    return found;
  };
  const auto configuration = read_configuration(file, judge);
  if (!configuration) return tl::make_unexpected(configuration.error());
  const Settings& written = configuration->settings;
  auto encoder = encoder::with_dbc(written.encoder, file);
  if (!encoder) return tl::make_unexpected(encoder.error());
  Settings settings = written;
  settings.encoder = *std::move(encoder);
  return RunningConfig(file, written, settings);
}

bool RunningConfig::reread() {
  const auto read_again = read(file_);
  if (!read_again) {
    spdlog::error("not reloaded, the old settings stay: {}",
                  in_one_line(read_again.error().message));
    return false;
  }
  const Reload change = reload(written_, read_again->written_);
  const EncoderSettings encoder = settings_.encoder;  // no key of it changes meanwhile
  settings_ = written_ = change.settings;
  settings_.encoder = encoder;
  spdlog::info("reloaded {}: {}{}", file_.string(),
               change.applied.empty() ? "nothing that can change now has" : "changed are ",
               fmt::join(change.applied, ", "));
  if (!change.refused.empty()) {
    spdlog::warn("needs a restart: {}", fmt::join(change.refused, ", "));
  }
  return !change.applied.empty();
}

}  // namespace scree
