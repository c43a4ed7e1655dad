#include "running_config.hpp"

#include <spdlog/fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "scree/config/configuration.hpp"
#include "scree/config/reload.hpp"
#include "scree/drivers/encoder/dbc.hpp"

namespace scree {

RunningConfig::RunningConfig(std::filesystem::path file, const Settings& written,
                             const Settings& settings)
    : file_(std::move(file)), written_(written), settings_(settings) {}

Result<RunningConfig> RunningConfig::read(const std::filesystem::path& file) {
  const auto configuration = read_configuration(file);
  if (!configuration) return tl::make_unexpected(configuration.error());
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
