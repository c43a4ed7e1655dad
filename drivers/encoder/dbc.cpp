#include "scree/drivers/encoder/dbc.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "dbc_text.hpp"
#include "scree/config/near_names.hpp"
#include "scree/core/lower_case.hpp"
#include "scree/core/read_file.hpp"

namespace scree::encoder {
namespace {

/// What a unit of the physical value is in metres, or metres per second.
struct Unit {
  std::string_view name;
  EncoderKind kind;
  double scale;
};
/// As people write them: km/h, KPH, "km / h", [km/hour], km·h-1.
std::string normal_unit(std::string_view unit) {
  struct Word {
    std::string_view written, brief;
  };
  constexpr std::array kDropped = {' ', '\t', '[', ']', '(', ')', '.', '^', '*', '_'};
  constexpr std::array kWords = {
      Word{"hour", "h"},        Word{"hr", "h"},         Word{"stunde", "h"},
      Word{"std", "h"},         Word{"second", "s"},     Word{"sekunde", "s"},
      Word{"sec", "s"},         Word{"per", "/"},        Word{"pro", "/"},
      Word{"kilometres", "km"}, Word{"kilometre", "km"}, Word{"kilometers", "km"},
      Word{"kilometer", "km"},  Word{"metres", "m"},     Word{"metre", "m"},
      Word{"meters", "m"},      Word{"meter", "m"},      Word{"miles", "mi"},
      Word{"mile", "mi"},       Word{"inch", "in"},      Word{"feet", "ft"},
      Word{"\xC2\xB7", ""},     Word{"\xC2\xB0", "deg"}, Word{"\xB0", "deg"}};
  std::string normal;
  for (const char c : lower_case(unit)) {
    if (std::ranges::find(kDropped, c) == kDropped.end()) normal += c;
  }
  for (const Word& word : kWords) {
    const auto at = normal.find(word.written);
    if (at != std::string::npos) normal.replace(at, word.written.size(), word.brief);
  }
  for (const std::string_view time : {"min", "h", "s"}) {
    const std::string power = std::string(time) + "-1";
    if (!normal.ends_with(power)) continue;
    normal.resize(normal.size() - power.size());
    return (normal.empty() ? "1" : normal) + "/" + std::string(time);
  }
  return normal;
}

constexpr double kKmh = 1 / 3.6, kMph = 0.44704, kKnot = 1852.0 / 3600, kFoot = 0.3048,
                 kInch = kFoot / 12, kMile = 1609.344;
constexpr std::array kUnits = {
    Unit{"m/s", EncoderKind::speed, 1},          Unit{"mps", EncoderKind::speed, 1},
    Unit{"dm/s", EncoderKind::speed, 0.1},       Unit{"cm/s", EncoderKind::speed, 0.01},
    Unit{"mm/s", EncoderKind::speed, 0.001},     Unit{"um/s", EncoderKind::speed, 1e-6},
    Unit{"m/min", EncoderKind::speed, 1.0 / 60}, Unit{"m/h", EncoderKind::speed, 1.0 / 3600},
    Unit{"km/h", EncoderKind::speed, kKmh},      Unit{"kph", EncoderKind::speed, kKmh},
    Unit{"kmh", EncoderKind::speed, kKmh},       Unit{"kmph", EncoderKind::speed, kKmh},
    Unit{"km-h", EncoderKind::speed, kKmh},      Unit{"km/s", EncoderKind::speed, 1000},
    Unit{"mph", EncoderKind::speed, kMph},       Unit{"mi/h", EncoderKind::speed, kMph},
    Unit{"kn", EncoderKind::speed, kKnot},       Unit{"kt", EncoderKind::speed, kKnot},
    Unit{"kts", EncoderKind::speed, kKnot},      Unit{"knot", EncoderKind::speed, kKnot},
    Unit{"knots", EncoderKind::speed, kKnot},    Unit{"fps", EncoderKind::speed, kFoot},
    Unit{"ft/s", EncoderKind::speed, kFoot},     Unit{"in/s", EncoderKind::speed, kInch},
    Unit{"m", EncoderKind::counter, 1},          Unit{"dm", EncoderKind::counter, 0.1},
    Unit{"cm", EncoderKind::counter, 0.01},      Unit{"mm", EncoderKind::counter, 0.001},
    Unit{"um", EncoderKind::counter, 1e-6},      Unit{"km", EncoderKind::counter, 1000},
    Unit{"in", EncoderKind::counter, kInch},     Unit{"ft", EncoderKind::counter, kFoot},
    Unit{"mi", EncoderKind::counter, kMile},
};

constexpr double kRadian = 1 / (2 * std::numbers::pi), kDegree = 1.0 / 360;

/// What a unit in which a wheel, or its motor, turns is in turns, or in turns a second.
struct TurnUnit {
  std::string_view name;
  EncoderKind kind;
  double rate;
};
constexpr std::array kTurnUnits = {TurnUnit{"rpm", EncoderKind::speed, 1.0 / 60},
                                   TurnUnit{"1/min", EncoderKind::speed, 1.0 / 60},
                                   TurnUnit{"u/min", EncoderKind::speed, 1.0 / 60},
                                   TurnUnit{"r/min", EncoderKind::speed, 1.0 / 60},
                                   TurnUnit{"rev/min", EncoderKind::speed, 1.0 / 60},
                                   TurnUnit{"rot/min", EncoderKind::speed, 1.0 / 60},
                                   TurnUnit{"tr/min", EncoderKind::speed, 1.0 / 60},
                                   TurnUnit{"rps", EncoderKind::speed, 1},
                                   TurnUnit{"hz", EncoderKind::speed, 1},
                                   TurnUnit{"1/s", EncoderKind::speed, 1},
                                   TurnUnit{"rev/s", EncoderKind::speed, 1},
                                   TurnUnit{"rad/s", EncoderKind::speed, kRadian},
                                   TurnUnit{"deg/s", EncoderKind::speed, kDegree},
                                   TurnUnit{"rev", EncoderKind::counter, 1},
                                   TurnUnit{"rad", EncoderKind::counter, kRadian},
                                   TurnUnit{"deg", EncoderKind::counter, kDegree}};

std::string wrong_kind(const EncoderSettings& settings, std::string_view unit) {
  return fmt::format("encoder.kind is {}, but the unit of {} is {}", name_of(settings.kind),
                     settings.signal, unit);
}

/// Why a rate of turn cannot be meant; empty when it can.
std::string contradiction(const EncoderSettings& settings, const TurnUnit& unit,
                          std::string_view written) {
  constexpr double kLargestWheel = 8;  // metres around
  if (settings.kind != unit.kind) return wrong_kind(settings, written);
  const double around = std::abs(settings.scale) / unit.rate;
  if (around <= kLargestWheel) return {};
  return fmt::format(
      "encoder.scale = {} cannot be for {}, whose unit is {}: the wheel would have "
      "{:.3g} m around; scale is what it rolls in a turn, times {:.4g}",
      settings.scale, settings.signal, written, around, unit.rate);
}

/// Why settings and unit contradict each other; empty when they do not, as far as can be known.
std::string contradiction(const EncoderSettings& settings, const DbcSignal& signal) {
  if (signal.is_float && settings.kind == EncoderKind::counter) {
    return fmt::format(
        "encoder.kind is counter, but {} is a floating-point number, which does not "
        "wrap: only a speed can be one",
        settings.signal);
  }
  const std::string_view unit = signal.unit;
  const std::string normal = normal_unit(unit);
  const auto* const turn = std::ranges::find(kTurnUnits, normal, &TurnUnit::name);
  if (turn != kTurnUnits.end()) return contradiction(settings, *turn, unit);
  const auto* const known = std::ranges::find(kUnits, normal, &Unit::name);
  const double scale = std::abs(settings.scale);
  const std::string_view metres = settings.kind == EncoderKind::speed ? "m/s" : "m";
  if (known == kUnits.end()) {
    constexpr std::array<std::string_view, 5> kNoUnit = {"", "-", "1", "none", "n/a"};
    const bool has_one = std::ranges::find(kNoUnit, normal) == kNoUnit.end();
    if (scale != 1 || !has_one) return {};
    return fmt::format(
        "encoder.scale = {} cannot be for {}, whose unit, {}, is not known: set what 1 {} is in {}",
        settings.scale, settings.signal, unit, unit, metres);
  }
  if (settings.kind != known->kind) return wrong_kind(settings, unit);
  const double ratio = scale / known->scale;
  const bool is_forgotten = scale == 1 && known->scale != 1;
  if (!is_forgotten && ratio <= 2 && ratio >= 0.5) return {};
  return fmt::format("encoder.scale = {} cannot be for {}, whose unit is {}: 1 {} is {:.6g} {}",
                     settings.scale, settings.signal, unit, unit, known->scale, metres);
}

/// What the messages and signals with long names are called.
class LongNames {
public:
  explicit LongNames(std::string_view dbc) {
    DbcText text(dbc);
    for (std::string_view line; text.next(line);) {
      if (const auto found = parse_long_name_line(line)) names_[key(found->of)] = found->name;
    }
  }
  std::string_view of_message(const MessageLine& message) const {
    return of({message.id, message.is_extended, {}, {}}, message.name);
  }
  std::string_view of_signal(const MessageLine& message, std::string_view name) const {
    return of({message.id, message.is_extended, name, {}}, name);
  }

private:
  using Key = std::tuple<std::uint32_t, bool, std::string_view>;
  static Key key(const MessageLine& of) { return {of.id, of.is_extended, of.name}; }
  std::string_view of(const MessageLine& what, std::string_view otherwise) const {
    const auto found = names_.find(key(what));
    return found == names_.end() ? otherwise : found->second;
  }

  std::map<Key, std::string_view> names_;
};

/// Looks at one line after another for the signal of a message, by its long name or its short one.
class SignalSearch {
public:
  SignalSearch(std::string_view dbc, std::string_view message, std::string_view signal)
      : long_names_(dbc), message_(message), signal_(signal) {}

  void take(std::string_view line, int number) {
    if (auto begun = parse_message_line(line)) {
      note_fault(begun->fault, number);
      at_ = std::move(*begun);
      if (at_.fault.empty()) messages_.push_back(long_names_.of_message(at_));
    } else if (auto part = parse_signal_line(line)) {
      // After a message line that cannot be read, nobody knows whose signal it is.
      const bool is_of_it = at_.name == message_ || long_names_.of_message(at_) == message_;
      if (at_.fault.empty() && is_of_it) take(*std::move(part), number);
    } else if (found_) {
      take_of_found(line);
    }
  }

  Result<DbcSignal> result(const std::string& origin, const DbcText& text) {
    if (found_ && found_->because) set_selector(*found_->because);
    if (found_ && found_->fault.empty()) return found_->signal;
    if (found_) {
      return fail(fmt::format("{}:{}: {}.{} {}", origin, line_, message_, signal_, found_->fault));
    }
    if (!fault_.empty()) return fail(fmt::format("{}:{}", origin, fault_));
    if (text.is_open() || (messages_.empty() && text.swallows())) {
      return fail(
          fmt::format("{}:{}: the text in quotes that begins here has no end: write a \\ "
                      "before its last quote as \\\\",
                      origin, text.quoted_from()));
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
    const std::string_view name = long_names_.of_signal(at_, part.name);
    signals_.push_back(name);
    if (part.is_selector) selectors_.push_back(part);
    if ((part.name != signal_ && name != signal_) || found_) return;
    part.signal.id = at_.id;
    part.signal.is_extended = at_.is_extended;
    found_ = std::move(part);
    line_ = number;
  }
  bool is_found(const MessageLine& signal) const {
    return signal.name == found_->name && signal.id == found_->signal.id;
  }
  /// Takes what stands behind all messages.
  void take_of_found(std::string_view line) {
    if (const auto real = parse_float_line(line); real && is_found(real->signal)) {
      make_float(*real);
    } else if (const auto values = parse_values_line(line); values && is_found(values->signal)) {
      found_->signal.unavailable = values->unavailable;
    } else if (const auto choice = parse_selection_line(line);
               choice && is_found(choice->signal) && !choice->is_one_value) {
      found_->fault = "is multiplexed by ranges of values (SG_MUL_VAL_)";
    }
  }
  /// Only a selector that is in every frame is understood.
  void set_selector(std::int64_t value) {
    if (selectors_.size() != 1 || selectors_[0].because || !selectors_[0].fault.empty()) {
      found_->fault = "is multiplexed by more than one selector that is in every frame";
      return;
    }
    found_->signal.selector = {selectors_[0].signal.place(), value};
  }
  void make_float(const FloatLine& line) {
    DbcSignal& signal = found_->signal;
    signal.is_float = true;
    if (signal.length != (line.type == 1 ? 32 : 64) || line.type > 2) {
      found_->fault = fmt::format("has {} bits, and is to be a floating-point number of type {}",
                                  signal.length, line.type);
    }
  }
  void note_fault(const std::string& fault, int number) {
    if (fault_.empty() && !fault.empty()) fault_ = fmt::format("{}: the line {}", number, fault);
  }

  LongNames long_names_;
  std::string_view message_, signal_;
  std::vector<std::string_view> messages_, signals_;
  std::string fault_;  // of the first line that cannot be read
  MessageLine at_;
  std::optional<SignalLine> found_;
  std::vector<SignalLine> selectors_;  // of the message
  int line_ = 0;                       // of what was found
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
  if (dbc.starts_with("\xFF\xFE") || dbc.starts_with("\xFE\xFF")) {
    return fail(origin + ":1: is text of 16 bits a character (UTF-16): save it as UTF-8");
  }
  SignalSearch search(dbc, message, signal);
  DbcText text(dbc);
  for (std::string_view line; text.next(line);) search.take(line, text.number());
  return search.result(origin, text);
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
  if (const auto reason = contradiction(settings, *signal); !reason.empty()) {
    return fail(reason);
  }
  EncoderSettings filled = settings;
  filled.can_id = signal->id;
  filled.is_extended = signal->is_extended;
  static_cast<SignalPlace&>(filled) = signal->place();
  filled.is_signed = signal->is_signed;
  filled.factor = signal->factor;
  filled.offset = signal->offset;
  filled.is_float = signal->is_float;
  if (signal->low < signal->high) {
    filled.lowest = signal->low;
    filled.highest = signal->high;
  }
  filled.unavailable = signal->unavailable;
  filled.selector = signal->selector;
  // What J1939's files give where they do not know the source (SAE J1939-21: the null address).
  constexpr std::int64_t kSource = 0xFF, kNullAddress = 0xFE;
  filled.any_source = signal->is_extended && (filled.can_id & kSource) == kNullAddress;
  return filled;
}

}  // namespace scree::encoder
