#include "scree/drivers/gpio/lines.hpp"

#include <array>
#include <cstdlib>
#include <utility>

#include "libgpiod.hpp"
#include "scree/core/nanoseconds.hpp"

namespace scree::gpio {
namespace {

struct LineName {
  std::string chip, line;
};

Result<LineName> parts_of(const std::string& name) {
  const std::size_t colon = name.rfind(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == name.size()) {
    return fail("must be CHIP:LINE, as gpiochip0:17 is");
  }
  return LineName{name.substr(0, colon), name.substr(colon + 1)};
}

Result<LineHandle> open_line(const std::string& name, bool is_active_low, bool is_output,
                             bool is_on) {
  const auto parts = parts_of(name);
  if (!parts) return tl::make_unexpected(parts.error());
  return request({parts->chip, parts->line, is_active_low, is_output, is_on});
}

/// The error of a key, which it names.
tl::unexpected<Error> of_key(const char* key, const std::string& name, const Error& error) {
  return fail(std::string("gpio.") + key + " = \"" + name + "\": " + error.message);
}

}  // namespace

Result<Output> Output::open(const std::string& name, bool is_active_low, bool is_on) {
  auto line = open_line(name, is_active_low, true, is_on);
  if (!line) return tl::make_unexpected(line.error());
  Output output;
  output.name_ = name;
  output.is_active_low_ = is_active_low;
  output.line_ = std::move(*line);
  return output;
}

bool Output::set(bool is_on) {
  if (line_ && gpio::set(*line_, is_on)) return true;
  line_.reset();
  auto line = open_line(name_, is_active_low_, true, is_on);
  if (line) line_ = std::move(*line);
  return line.has_value();
}

Result<PulseInput> PulseInput::open(const std::string& name, bool is_active_low) {
  auto line = open_line(name, is_active_low, false, false);
  if (!line) return tl::make_unexpected(line.error());
  PulseInput input;
  input.name_ = name;
  input.is_active_low_ = is_active_low;
  input.line_ = std::move(*line);
  return input;
}

int PulseInput::descriptor() {
  if (!line_) {
    auto line = open_line(name_, is_active_low_, false, false);
    if (line) line_ = std::move(*line);
  }
  return line_ ? descriptor_of(*line_) : -1;
}

std::optional<std::int64_t> PulseInput::read() {
  const auto stamp_ns = line_ ? read_edge(*line_) : std::nullopt;
  if (!stamp_ns) return std::nullopt;
  return edge_host_ns(*stamp_ns, read_clock(CLOCK_MONOTONIC), read_clock(CLOCK_REALTIME));
}

Result<std::string> holder_of(const std::string& name) {
  const auto parts = parts_of(name);
  if (!parts) return tl::make_unexpected(parts.error());
  return holder_of(parts->chip, parts->line);
}

Result<void> check_name(const std::string& name) {
  if (name.empty()) return {};
  const auto parts = parts_of(name);
  return parts ? Result<void>() : fail("\"" + name + "\" " + parts.error().message);
}

Result<void> check_lines(const GpioSettings& settings) {
  const std::array named{std::pair("pps", &settings.pps), std::pair("stop", &settings.stop),
                         std::pair("heartbeat", &settings.heartbeat)};
  for (const auto& [key, name] : named) {
    const auto parts = parts_of(*name);
    if (!parts) continue;  // none, or what check_name() refuses
    const auto there = check_line(parts->chip, parts->line);
    if (!there) return of_key(key, *name, there.error());
  }
  return {};
}

Result<Lines> Lines::open(const GpioSettings& settings) {
  Lines lines;
  if (!settings.pps.empty()) {
    auto line = PulseInput::open(settings.pps, settings.pps_active_low);
    if (!line) return of_key("pps", settings.pps, line.error());
    lines.pps = std::move(*line);
  }
  if (!settings.stop.empty()) {
    auto line = Output::open(settings.stop, settings.stop_active_low, true);
    if (!line) return of_key("stop", settings.stop, line.error());
    lines.stop = std::move(*line);
  }
  if (!settings.heartbeat.empty()) {
    auto line = Output::open(settings.heartbeat, settings.heartbeat_active_low, false);
    if (!line) return of_key("heartbeat", settings.heartbeat, line.error());
    lines.heartbeat = std::move(*line);
  }
  return lines;
}

std::int64_t edge_host_ns(std::int64_t stamp_ns, std::int64_t monotonic_now_ns,
                          std::int64_t host_now_ns) {
  const bool is_monotonic =
      std::abs(stamp_ns - monotonic_now_ns) < std::abs(stamp_ns - host_now_ns);
  return is_monotonic ? stamp_ns + (host_now_ns - monotonic_now_ns) : stamp_ns;
}

}  // namespace scree::gpio
