#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "scree/drivers/encoder/dbc.hpp"

namespace scree::encoder {

/// The lines of a DBC file that begin outside of quotes: a comment may be many lines long and hold
/// anything.
class DbcText {
public:
  explicit DbcText(std::string_view text) : rest_(text) {}

  /// False at the end.
  bool next(std::string_view& line);
  /// Of the line that was given last, from 1.
  int number() const { return number_; }
  /// The line whose quotes are still open at the end of the text; 0 where none are.
  int unclosed() const { return is_quoted_ ? quoted_from_ : 0; }

private:
  std::string_view rest_;
  int number_ = 0, quoted_from_ = 0;
  bool is_quoted_ = false;
};

/// `BO_ 464 WHEEL_SPEEDS: 8 VSA`
struct MessageLine {
  std::uint32_t id = 0;
  bool is_extended = false;
  std::string_view name;
  std::string fault;  ///< what the line lacks; empty when it can be read
};
/// Nothing where the line is none of that kind, as below.
std::optional<MessageLine> parse_message_line(std::string_view line);

/// `SG_ WHEEL_SPEED_FL : 7|15@0+ (0.01,0) [0|250] "kph" EON`, whose message stands before it.
struct SignalLine {
  std::string_view name;
  std::string fault;  ///< why it cannot be used; empty when it can
  DbcSignal signal;
};
std::optional<SignalLine> parse_signal_line(std::string_view line);

/// The signal that `SIG_VALTYPE_ 464 WHEEL_SPEED_FL : 1;` makes a floating-point number.
std::optional<MessageLine> parse_float_line(std::string_view line);

}  // namespace scree::encoder
