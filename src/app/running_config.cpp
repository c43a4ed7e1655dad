#include "running_config.hpp"

#include <spdlog/fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "scree/config/configuration.hpp"
#include "scree/config/reload.hpp"
#include "scree/drivers/encoder/dbc.hpp"
#include "scree/drivers/gpio/lines.hpp"
#include "scree/drivers/velodyne/udp_receiver.hpp"
#include "scree/drivers/xsens/start_up.hpp"
#include "scree/publish/multicast.hpp"

namespace scree {
namespace {

/// What those who will use a value say of it, which the table of keys cannot judge.
std::optional<Error> unusable(const Configuration& configuration) {
  const Settings& settings = configuration.settings;
  const auto judged = [](const auto& result) {
    return result ? std::nullopt : std::optional(result.error().message);
  };
  const std::pair<std::string_view, std::optional<std::string>> reasons[] = {
      {"lidar.address", judged(local_address(settings.lidar.address))},
      {"lidar.sender", judged(sender_address(settings.lidar.sender))},
      {"imu.baud", xsens::line_too_slow(settings.imu)},
      {"gpio.pps", judged(gpio::check_name(settings.gpio.pps))},
      {"gpio.stop", judged(gpio::check_name(settings.gpio.stop))},
      {"gpio.heartbeat", judged(gpio::check_name(settings.gpio.heartbeat))},
      {"lcm.url", judged(check_lcm_url(settings.lcm.url))}};
  for (const auto& [key, reason] : reasons) {
    if (reason) {
      std::string sentence =
          fmt::format("{}: {}: {}", configuration.source_of(key).text(), key, *reason);
      std::ranges::replace_if(
          sentence, [](unsigned char c) { return c < ' '; }, '?');
      return Error{std::move(sentence)};
    }
  }
  return std::nullopt;
}

}  // namespace

RunningConfig::RunningConfig(std::filesystem::path file, const Settings& written,
                             const Settings& settings)
    : file_(std::move(file)), written_(written), settings_(settings) {}

Result<RunningConfig> RunningConfig::read(const std::filesystem::path& file) {
  const auto configuration = read_configuration(file);
  if (!configuration) return tl::make_unexpected(configuration.error());
  if (const auto reason = unusable(*configuration)) return tl::make_unexpected(*reason);
  const Settings& written = configuration->settings;
  auto encoder = encoder::with_dbc(written.encoder, file);
  if (!encoder) {
    return fail(fmt::format("{}: {}", configuration->source_of("encoder.signal").text(),
                            encoder.error().message));
  }
  Settings settings = written;
  settings.encoder = *std::move(encoder);
  return RunningConfig(file, written, settings);
}

bool RunningConfig::reread() {
  const auto read_again = read(file_);
  if (!read_again) {
    spdlog::error("not reloaded, the old settings stay: {}", read_again.error().message);
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
