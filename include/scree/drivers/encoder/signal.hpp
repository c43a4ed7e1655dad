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

/// What a raw value means: metres for a counter, m/s for a speed.
double scaled(const EncoderSettings& layout, std::int64_t raw);

/// Metres, or m/s, of one step of the raw value; not below zero. Zero for a floating-point one.
double quantum(const EncoderSettings& layout);

}  // namespace scree::encoder
