#include "dbc_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "scree/core/byte_order_mark.hpp"
#include "scree/core/can_frame.hpp"
#include "scree/core/lower_case.hpp"

namespace scree::encoder {
namespace {

constexpr std::uint32_t kExtendedFlag = 0x80000000;

bool is_name(char c) {
  // Letters beyond ASCII are not allowed, and written.
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}

/// Reads a line piece by piece, with blanks between any two; after a piece that is not there
/// nothing more is read.
class Scanner {
public:
  explicit Scanner(std::string_view line) : rest_(line) {}

  bool is_good() const { return missing_.empty(); }
  std::string fault() const { return "cannot be read, it lacks " + missing_; }

  void expect(char c) {
    if (!take(c)) stop(std::string("a '") + c + "'");
  }
  bool take(char c) {
    skip_blanks();
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  /// A keyword or a name.
  std::string_view name() {
    skip_blanks();
    std::size_t length = 0;
    while (length < rest_.size() && is_name(rest_[length])) ++length;
    const std::string_view name = rest_.substr(0, length);
    rest_.remove_prefix(length);
    if (name.empty()) stop("a name");
    return name;
  }
  template <class T>
  T number() {
    skip_blanks();
    if (rest_.starts_with('+')) rest_.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc()) {
      stop("a number");
    } else {
      rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    }
    return value;
  }
  /// What stands between the next two quotes.
  std::string_view quoted() {
    const std::size_t begin = std::min(rest_.find('"'), rest_.size());
    const std::size_t end = rest_.find('"', begin + 1);
    if (end == std::string_view::npos) {
      stop("a text in quotes");
      return {};
    }
    const std::string_view text = rest_.substr(begin + 1, end - begin - 1);
    rest_.remove_prefix(end + 1);
    return text;
  }

private:
  void skip_blanks() {
    while (rest_.starts_with(' ') || rest_.starts_with('\t')) rest_.remove_prefix(1);
  }
  void stop(std::string missing) {
    if (is_good()) missing_ = std::move(missing);
    rest_ = {};
  }

  std::string_view rest_;
  std::string missing_;  // the first piece that is not there
};

bool is_keyword(Scanner& scanner, std::string_view keyword) {
  return scanner.name() == keyword;
}

void set_id(MessageLine& message, std::uint32_t id) {
  message.is_extended = (id & kExtendedFlag) != 0;
  message.id = id & kLargestExtendedId;
}

/// Takes the identifier of a message and the name of a signal in it.
void take_signal(Scanner& scanner, MessageLine& signal) {
  set_id(signal, scanner.number<std::uint32_t>());
  signal.name = scanner.name();
}

/// Whether a line begins as a message or a signal.
bool is_statement(std::string_view line) {
  const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
  const std::string_view first = line.substr(begin, 4);
  return first == "BO_ " || first == "SG_ ";
}

/// Cuts off the message or signal that follows another one on its line. @return it, or nothing
std::string_view cut_next_statement(std::string_view& line) {
  if (!is_statement(line)) return {};
  bool is_quoted = false;
  for (std::size_t i = line.find('_'); i + 4 < line.size(); ++i) {
    if (line[i] == '"') is_quoted = !is_quoted;
    const std::string_view word = line.substr(i + 1, 4);
    if (is_quoted || (line[i] != ' ' && line[i] != '\t')) continue;
    if (word != "BO_ " && word != "SG_ ") continue;
    const std::string_view rest = line.substr(i + 1);
    line = line.substr(0, i);
    return rest;
  }
  return {};
}

/// M is the selector, which is in every frame; m0 only in those where it is 0; m0M selects, too.
void set_multiplexing(SignalLine& line, std::string_view word) {
  line.is_selector = word.ends_with('M');
  if (line.is_selector) word.remove_suffix(1);
  if (!word.starts_with('m')) return;
  Scanner scanner(word.substr(1));
  line.because = scanner.number<std::int64_t>();
}

/// What is no range is passed over.
void take_range(Scanner& scanner, DbcSignal& signal) {
  Scanner range = scanner;
  range.expect('[');
  signal.low = range.number<double>();
  range.expect('|');
  signal.high = range.number<double>();
  range.expect(']');
  if (range.is_good()) {
    scanner = range;
  } else {
    signal.low = signal.high = 0;
  }
}

/// Whether the name of a value says that there is none: "SNA", "Sensor error", not "no error".
bool names_no_value(std::string_view name) {
  const std::string label = lower_case(name);
  constexpr std::array kWhole = {"sna", "na", "n/a", "fault"};
  constexpr std::array kPart = {"not avail", "notavail", "not_avail", "unavail",
                                "invalid",   "error",    "undefined"};
  const bool is_denied = label.starts_with("no ") || label.starts_with("no_");
  return std::ranges::find(kWhole, label) != kWhole.end() ||
         (!is_denied && std::ranges::any_of(kPart, [&](const char* part) {
           return label.find(part) != std::string::npos;
         }));
}

bool fits_a_frame(const DbcSignal& signal) {
  constexpr int kBits = 512;
  if (signal.start_bit < 0 || signal.start_bit >= kBits) return false;
  if (signal.length < 1 || signal.length > 64) return false;
  return signal.frame_bytes() <= kBits / 8;
}

}  // namespace

DbcText::DbcText(std::string_view text) : rest_(text) {
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

bool DbcText::next(std::string_view& line) {
  if (!more_.empty()) {
    line = more_;
    more_ = cut_next_statement(line);
    return true;
  }
  while (!rest_.empty()) {
    const std::size_t length = rest_.find('\n');
    line = rest_.substr(0, length);
    rest_.remove_prefix(length == std::string_view::npos ? rest_.size() : length + 1);
    ++number_;
    const bool began_quoted = is_quoted_;
    if (began_quoted && swallowing_from_ == 0 && is_statement(line)) {
      swallowing_from_ = quoted_from_;
    }
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '\\') {
        ++i;  // \" is a quote inside
      } else if (line[i] == '"') {
        is_quoted_ = !is_quoted_;
        if (is_quoted_) quoted_from_ = number_;
      }
    }
    if (began_quoted) continue;
    more_ = cut_next_statement(line);
    return true;
  }
  return false;
}

std::optional<MessageLine> parse_message_line(std::string_view line) {
  Scanner scanner(line);
  if (!is_keyword(scanner, "BO_")) return std::nullopt;
  MessageLine message;
  set_id(message, scanner.number<std::uint32_t>());
  message.name = scanner.name();
  scanner.expect(':');
  if (!scanner.is_good()) message.fault = scanner.fault();
  return message;
}

std::optional<SignalLine> parse_signal_line(std::string_view line) {
  Scanner scanner(line);
  if (!is_keyword(scanner, "SG_")) return std::nullopt;
  SignalLine result;
  result.name = scanner.name();
  DbcSignal& signal = result.signal;
  if (!scanner.take(':')) {
    set_multiplexing(result, scanner.name());
    scanner.expect(':');
  }
  signal.start_bit = scanner.number<int>();
  scanner.expect('|');
  signal.length = scanner.number<int>();
  scanner.expect('@');
  const bool is_little = scanner.take('1');
  if (!is_little) scanner.expect('0');
  signal.byte_order = is_little ? ByteOrder::little_endian : ByteOrder::big_endian;
  signal.is_signed = scanner.take('-');
  if (!signal.is_signed) scanner.expect('+');
  scanner.expect('(');
  signal.factor = scanner.number<double>();
  scanner.expect(',');
  signal.offset = scanner.number<double>();
  scanner.expect(')');
  take_range(scanner, signal);
  signal.unit = scanner.quoted();
  if (!scanner.is_good()) {
    result.fault = scanner.fault();
  } else if (!fits_a_frame(signal)) {
    result.fault = "lies outside of any frame, or is not 1 to 64 bits long";
  } else if (!std::isnormal(signal.factor) || !std::isfinite(signal.offset)) {
    result.fault = "has a factor or an offset that is no number to scale with";
  }
  return result;
}

std::optional<FloatLine> parse_float_line(std::string_view line) {
  Scanner scanner(line);
  if (!is_keyword(scanner, "SIG_VALTYPE_")) return std::nullopt;
  FloatLine result;
  take_signal(scanner, result.signal);
  scanner.take(':');
  result.type = scanner.number<int>();
  if (!scanner.is_good() || result.type == 0) return std::nullopt;
  return result;
}

std::optional<ValuesLine> parse_values_line(std::string_view line) {
  Scanner scanner(line);
  if (!is_keyword(scanner, "VAL_")) return std::nullopt;
  ValuesLine result;
  take_signal(scanner, result.signal);
  while (true) {
    const auto value = scanner.number<std::int64_t>();
    const std::string_view name = scanner.quoted();
    if (!scanner.is_good()) return result;
    if (names_no_value(name)) result.unavailable.push_back(value);
  }
}

std::optional<SelectionLine> parse_selection_line(std::string_view line) {
  Scanner scanner(line);
  if (!is_keyword(scanner, "SG_MUL_VAL_")) return std::nullopt;
  SelectionLine result;
  take_signal(scanner, result.signal);
  result.selector = scanner.name();
  const auto first = scanner.number<std::int64_t>();
  scanner.expect('-');
  result.is_one_value = scanner.number<std::int64_t>() == first && !scanner.take(',');
  return result;
}

std::optional<LongNameLine> parse_long_name_line(std::string_view line) {
  Scanner scanner(line);
  if (!is_keyword(scanner, "BA_")) return std::nullopt;
  const std::string_view attribute = scanner.quoted();
  const bool is_signal = attribute == "SystemSignalLongSymbol";
  if (!is_signal && attribute != "SystemMessageLongSymbol") return std::nullopt;
  LongNameLine result;
  if (scanner.name() != (is_signal ? "SG_" : "BO_")) return std::nullopt;
  set_id(result.of, scanner.number<std::uint32_t>());
  if (is_signal) result.of.name = scanner.name();
  result.name = scanner.quoted();
  if (!scanner.is_good()) return std::nullopt;
  return result;
}

}  // namespace scree::encoder
