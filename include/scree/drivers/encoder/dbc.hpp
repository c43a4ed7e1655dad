#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scree/config/settings.hpp"
#include "scree/core/result.hpp"

// DBC files, which describe what the frames of a CAN bus hold (Vector, "DBC File Format
// Documentation", version 1.0/5: sections 8 Message Definitions and 8.2 Signal Definitions).
namespace scree::encoder {

/// One signal of one message.
struct DbcSignal : SignalPlace {
  SignalPlace place() const { return {start_bit, length, byte_order}; }

  std::uint32_t id = 0;  ///< of the frame
  bool is_extended = false;
  bool is_signed = false;
  double factor = 1, offset = 0;          ///< raw * factor + offset is the physical value ...
  std::string unit;                       ///< ... in this unit, which is free text
  bool is_float = false;                  ///< raw is the bits of a float or a double
  double low = 0, high = 0;               ///< range of the physical value; equal: unknown
  std::vector<std::int64_t> unavailable;  ///< raw values that are named as no value (VAL_)
  std::optional<EncoderSettings::Selector> selector;  ///< where it is multiplexed
};

/// Finds MESSAGE.SIGNAL in a file's text. Lines that tell nothing of signals are passed over. One
/// sentence where there is no such message or signal (with the names that are nearest, or the first
/// line that cannot be read), where it does not fit a frame, or is multiplexed in another way than
/// by one value of one selector. `origin` stands for the file's name in it.
Result<DbcSignal> find_signal(std::string_view dbc, std::string_view name,
                              const std::string& origin);

/// Settings with the place of the signal from their DBC file; as they are where they name none.
/// `scale` then multiplies the physical value, whose unit is often km/h: a sentence too where that
/// unit is known and the scale cannot be meant for it, or for this kind.
/// @param config_file beside which a relative path is looked for first; may be empty
Result<EncoderSettings> with_dbc(const EncoderSettings& settings,
                                 const std::filesystem::path& config_file);

}  // namespace scree::encoder
