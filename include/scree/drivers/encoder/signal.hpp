#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "scree/config/settings.hpp"

namespace scree::encoder {

/// Reads a signal by the rules of DBC files, two's complement where it is signed. Bit 0 of a byte
/// is its lowest. The start bit is 8 * byte + bit of the signal's
/// - lowest bit, little_endian ("Intel", @1): the signal runs upwards from there;
/// - highest bit, big_endian ("Motorola", @0): it runs down to bit 0 of that byte and on from bit 7
///   of the next.
/// An unsigned signal of 64 bits keeps its bits. Nothing where the data end before the
/// signal does. @pre length is 1 to 64
std::optional<std::int64_t> read_signal(const EncoderSettings& layout,
                                        std::span<const std::uint8_t> data);

/// Whether a raw value stands for none: named so in the DBC file, or one of the highest of its bits
/// (the lowest, too, of a signed one), which are codes by custom, and outside of the signal's range
/// (SAE J1939-71, 5.1.2: from 251/256 of the bits on).
bool is_unavailable(const EncoderSettings& layout, std::int64_t raw);

/// Whether a frame that may hold the signal has the value of the selector for it. True where there
/// is no selector, nothing where the data end before it.
std::optional<bool> is_selected(const EncoderSettings& layout, std::span<const std::uint8_t> data);

/// What a raw value means: metres for a counter, m/s for a speed.
double scaled(const EncoderSettings& layout, std::int64_t raw);

/// Metres, or m/s, of one step of the raw value; not below zero. Zero for a floating-point one.
double quantum(const EncoderSettings& layout);

}  // namespace scree::encoder
