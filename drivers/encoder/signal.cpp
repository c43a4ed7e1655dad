#include "scree/drivers/encoder/signal.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace scree::encoder {

namespace {

std::optional<std::uint64_t> read_bits(const SignalPlace& place,
                                       std::span<const std::uint8_t> data) {
  if (data.size() < static_cast<std::size_t>(place.frame_bytes())) return std::nullopt;
  const bool is_little = place.byte_order == ByteOrder::little_endian;
  std::uint64_t bits = 0;
  int at = place.start_bit;
  for (int i = 0; i < place.length; ++i) {
    const auto byte = data[static_cast<std::size_t>(at / 8)];
    const std::uint64_t bit = (byte >> static_cast<unsigned>(at % 8)) & 1U;
    if (is_little) {
      bits |= bit << static_cast<unsigned>(i);
      ++at;
    } else {
      bits = bits << 1U | bit;
      at += at % 8 == 0 ? 15 : -1;
    }
  }
  return bits;
}

double number_of(const EncoderSettings& layout, std::int64_t raw) {
  const auto bits = static_cast<std::uint64_t>(raw);
  if (layout.is_float && layout.length == 64) return std::bit_cast<double>(bits);
  if (layout.is_float) return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
  return layout.is_signed ? static_cast<double>(raw) : static_cast<double>(bits);
}

double physical(const EncoderSettings& layout, std::int64_t raw) {
  return number_of(layout, raw) * layout.factor + layout.offset;
}

}  // namespace

std::optional<std::int64_t> read_signal(const EncoderSettings& layout,
                                        std::span<const std::uint8_t> data) {
  const auto bits = read_bits(layout, data);
  if (!bits) return std::nullopt;
  const auto unused = static_cast<unsigned>(64 - layout.length);
  if (layout.is_signed) return static_cast<std::int64_t>(*bits << unused) >> unused;
  return static_cast<std::int64_t>(*bits);
}

double scaled(const EncoderSettings& layout, std::int64_t raw) {
  return physical(layout, raw) * layout.scale;
}

bool is_unavailable(const EncoderSettings& layout, std::int64_t raw) {
  constexpr double kCodes = 251.0 / 256;
  constexpr int kFewestBits = 8;
  if (std::ranges::find(layout.unavailable, raw) != layout.unavailable.end()) return true;
  const double value = physical(layout, raw);
  if (value >= layout.lowest && value <= layout.highest) return false;
  if (layout.is_float || layout.length < kFewestBits) return false;
  const double end = std::ldexp(1.0, layout.is_signed ? layout.length - 1 : layout.length);
  const double number = number_of(layout, raw);
  return layout.is_signed ? number >= end - 1 || number <= -end : number >= kCodes * end;
}

std::optional<bool> is_selected(const EncoderSettings& layout, std::span<const std::uint8_t> data) {
  if (!layout.selector) return true;
  const auto bits = read_bits(*layout.selector, data);
  if (!bits) return std::nullopt;
  return static_cast<std::int64_t>(*bits) == layout.selector->value;
}

double quantum(const EncoderSettings& layout) {
  return layout.is_float ? 0 : std::abs(layout.factor * layout.scale);
}

}  // namespace scree::encoder
