#include "scree/drivers/encoder/dbc.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "dbc_text.hpp"
#include "scree/config/near_names.hpp"
#include "scree/core/read_file.hpp"

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

/// Looks at one line after another for the signal of a message.
class SignalSearch {
public:
  SignalSearch(std::string_view message, std::string_view signal)
      : message_(message), signal_(signal) {}

  void take(std::string_view line, int number) {
    if (auto begun = parse_message_line(line)) {
      note_fault(begun->fault, number);
      at_ = std::move(*begun);
      if (at_.fault.empty()) messages_.push_back(at_.name);
    } else if (auto part = parse_signal_line(line)) {
      // After a message line that cannot be read, nobody knows whose signal it is.
      if (at_.fault.empty() && at_.name == message_) take(*std::move(part), number);
    } else if (const auto real = parse_float_line(line); real && found_ && real->name == signal_) {
      const bool is_it = real->id == found_->signal.id;
      if (is_it) found_->fault = "is a floating-point number, of which no count can be read";
    }
  }

  Result<DbcSignal> result(const std::string& origin, int unclosed) const {
    if (found_ && found_->fault.empty()) return found_->signal;
    if (found_) {
      return fail(fmt::format("{}:{}: {}.{} {}", origin, line_, message_, signal_, found_->fault));
    }
    if (!fault_.empty()) return fail(fmt::format("{}:{}", origin, fault_));
    if (unclosed > 0) {
      return fail(
          fmt::format("{}:{}: the text in quotes that begins here has no end: write a \\ "
                      "before its last quote as \\\\",
                      origin, unclosed));
    }
    if (messages_.empty()) return fail(origin + ": holds no message, it is no DBC file");
    if (signals_.empty()) {
      return fail(fmt::format("{}: no message {} with signals; the nearest are {}", origin,
                              message_, near_names(message_, messages_)));
    }
    return fail(fmt::format("{}: message {} has no signal {}; the nearest are {}", origin, message_,
                            signal_, near_names(signal_, signals_)));
  }

private:
  void take(SignalLine part, int number) {
    signals_.push_back(part.name);
    if (part.name != signal_ || found_) return;
    part.signal.id = at_.id;
    part.signal.is_extended = at_.is_extended;
    found_ = std::move(part);
    line_ = number;
  }
  void note_fault(const std::string& fault, int number) {
    if (fault_.empty() && !fault.empty()) fault_ = fmt::format("{}: the line {}", number, fault);
  }

  std::string_view message_, signal_;
  std::vector<std::string_view> messages_, signals_;
  std::string fault_;  // of the first line that cannot be read
  MessageLine at_;
  std::optional<SignalLine> found_;
  int line_ = 0;  // of what was found
};

}  // namespace

Result<DbcSignal> find_signal(std::string_view dbc, std::string_view name,
                              const std::string& origin) {
  const std::size_t dot = std::min(name.find('.'), name.size());
  const std::string_view message = name.substr(0, dot);
  const std::string_view signal = name.substr(std::min(dot + 1, name.size()));
  if (message.empty() || signal.empty()) {
    return fail(fmt::format("encoder.signal = \"{}\" must be MESSAGE.SIGNAL of {}", name, origin));
  }
  SignalSearch search(message, signal);
  DbcText text(dbc);
  for (std::string_view line; text.next(line);) search.take(line, text.number());
  return search.result(origin, text.unclosed());
}

Result<EncoderSettings> with_dbc(const EncoderSettings& settings,
                                 const std::filesystem::path& config_file) {
  if (settings.dbc.empty()) return settings;
  const auto file = find_file(settings.dbc, config_file);
  if (!file) return tl::make_unexpected(file.error());
  constexpr std::uintmax_t kLargestFile = 16 << 20;
  const auto text = read_file(*file, kLargestFile);
  if (!text) return tl::make_unexpected(text.error());
  const auto signal = find_signal(*text, settings.signal, file->string());
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
