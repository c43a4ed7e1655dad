#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scree/drivers/encoder/dbc.hpp"

namespace scree::encoder {

/// The lines of a DBC file that begin outside of quotes: a comment may be many lines long and hold
/// anything. Where messages and signals stand on one line, each is given as a line of its own.
class DbcText {
public:
  /// @param text perhaps with the byte order mark of UTF-8
  explicit DbcText(std::string_view text);

  /// False at the end.
  bool next(std::string_view& line);
  /// Of the line that was given last, from 1.
  int number() const { return number_; }
  /// Whether quotes are still open at the end of the text.
  bool is_open() const { return is_quoted_; }
  /// Whether messages or signals stand in quotes.
  bool swallows() const { return swallowing_from_ > 0; }
  /// The line of the first quote behind which messages or signals stand, else of the last one; 0:
  /// none.
  int quoted_from() const { return swallowing_from_ > 0 ? swallowing_from_ : quoted_from_; }

private:
  std::string_view rest_;
  std::string_view more_;  // of the line that was given last
  int number_ = 0, quoted_from_ = 0, swallowing_from_ = 0;
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
  bool is_selector = false;             ///< M: other signals are there by its value
  std::optional<std::int64_t> because;  ///< m3: it is there where the selector is 3
};
std::optional<SignalLine> parse_signal_line(std::string_view line);

/// The signal that `SIG_VALTYPE_ 464 WHEEL_SPEED_FL : 1;` makes a floating-point number: type 1 of
/// 32 bits, 2 of 64.
struct FloatLine {
  MessageLine signal;  ///< by its name, and the identifier of its message
  int type = 0;
};
std::optional<FloatLine> parse_float_line(std::string_view line);

/// `VAL_ 464 WHEEL_SPEED_FL 255 "SNA" 254 "Error";`: those of its values that stand for none.
struct ValuesLine {
  MessageLine signal;  ///< as above
  std::vector<std::int64_t> unavailable;
};
std::optional<ValuesLine> parse_values_line(std::string_view line);

/// `SG_MUL_VAL_ 464 SPEED MODE 3-3, 5-7;`: where MODE has these values SPEED is there.
struct SelectionLine {
  MessageLine signal;  ///< as above
  std::string_view selector;
  bool is_one_value = false;
};
std::optional<SelectionLine> parse_selection_line(std::string_view line);

/// `BA_ "SystemSignalLongSymbol" SG_ 464 SHORT "LONG";`, or SystemMessageLongSymbol BO_ without
/// SHORT: names of more than 32 characters stand at the end of a file, as every tool shows them.
struct LongNameLine {
  MessageLine of;  ///< of a message by its identifier, of a signal by its short name, too
  std::string_view name;
};
std::optional<LongNameLine> parse_long_name_line(std::string_view line);

}  // namespace scree::encoder
