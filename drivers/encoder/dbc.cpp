#include "scree/drivers/encoder/dbc.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <vector>

#include "dbc_text.hpp"
#include "scree/config/near_names.hpp"

namespace scree::encoder {
namespace {

/// What a unit of the physical value is in metres, or metres per second.
struct Unit {
  std::string_view name;
  EncoderKind kind;
  double scale;
};
constexpr std::array kUnits = {
    Unit{"m/s", EncoderKind::speed, 1},        Unit{"mm/s", EncoderKind::speed, 0.001},
    Unit{"km/h", EncoderKind::speed, 1 / 3.6}, Unit{"kph", EncoderKind::speed, 1 / 3.6},
    Unit{"kmh", EncoderKind::speed, 1 / 3.6},  Unit{"mph", EncoderKind::speed, 0.44704},
    Unit{"m", EncoderKind::counter, 1},        Unit{"cm", EncoderKind::counter, 0.01},
    Unit{"mm", EncoderKind::counter, 0.001},   Unit{"km", EncoderKind::counter, 1000},
};

/// Why settings and unit contradict each other; empty when they do not, as far as can be known.
std::string contradiction(const EncoderSettings& settings, std::string_view unit) {
  for (const Unit& known : kUnits) {
    if (unit != known.name) continue;
    if (settings.kind != known.kind) {
      return fmt::format("encoder.kind is {}, but the unit of {} is {}", name_of(settings.kind),
                         settings.signal, unit);
    }
    const double ratio = std::abs(settings.scale) / known.scale;
    if (ratio > 2 || ratio < 0.5) {
      return fmt::format("encoder.scale = {} cannot be for {}, whose unit is {}: 1 {} is {:.6g} {}",
                         settings.scale, settings.signal, unit, unit, known.scale,
                         known.kind == EncoderKind::speed ? "m/s" : "m");
    }
  }
  return {};
}

}  // namespace

Result<DbcSignal> find_signal(std::string_view dbc, std::string_view name,
                              const std::string& origin) {
  const std::size_t dot = std::min(name.find('.'), name.size());
  const std::string_view message = name.substr(0, dot);
  const std::string_view signal = name.substr(std::min(dot + 1, name.size()));
  if (message.empty() || signal.empty()) {
    return fail(fmt::format("encoder.signal = \"{}\" must be MESSAGE.SIGNAL of {}", name, origin));
  }
  std::vector<std::string_view> messages, signals;
  std::optional<SignalLine> found;
  MessageLine at;
  DbcText text(dbc);
  for (std::string_view line; text.next(line);) {
    if (const auto begun = parse_message_line(line)) {
      at = *begun;
      messages.push_back(at.name);
    } else if (auto part = parse_signal_line(line); part && at.name == message) {
      signals.push_back(part->name);
      if (part->name != signal || found) continue;
      found = std::move(part);
      found->signal.id = at.id;
      found->signal.is_extended = at.is_extended;
    } else if (const auto real = parse_float_line(line); real && found && real->name == signal) {
      const bool is_it = real->id == found->signal.id;
      if (is_it) found->fault = "is a floating-point number, of which no count can be read";
    }
  }
  if (found && found->fault.empty()) return found->signal;
  if (found) return fail(fmt::format("{}: {} {}", origin, name, found->fault));
  if (messages.empty()) return fail(origin + ": holds no message, it is no DBC file");
  if (signals.empty()) {
    return fail(fmt::format("{}: no message {} with signals; the nearest are {}", origin, message,
                            near_names(message, messages)));
  }
  return fail(fmt::format("{}: message {} has no signal {}; the nearest are {}", origin, message,
                          signal, near_names(signal, signals)));
}

Result<EncoderSettings> with_dbc(const EncoderSettings& settings,
                                 const std::filesystem::path& config_file) {
  if (settings.dbc.empty()) return settings;
  const auto file = find_file(settings.dbc, config_file);
  if (!file) return tl::make_unexpected(file.error());
  std::ifstream stream(*file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) return fail(fmt::format("cannot read {}", file->string()));
  const auto signal = find_signal(text, settings.signal, file->string());
  if (!signal) return tl::make_unexpected(signal.error());
  if (const auto reason = contradiction(settings, signal->unit); !reason.empty()) {
    return fail(reason);
  }
  EncoderSettings filled = settings;
  filled.can_id = signal->id;
  filled.is_extended = signal->is_extended;
  filled.start_bit = signal->start_bit;
  filled.length = signal->length;
  filled.byte_order = signal->byte_order;
  filled.is_signed = signal->is_signed;
  filled.factor = signal->factor;
  filled.offset = signal->offset;
  return filled;
}

}  // namespace scree::encoder
