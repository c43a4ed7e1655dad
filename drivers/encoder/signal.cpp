#include "scree/drivers/encoder/signal.hpp"

#include <bit>
#include <cmath>

namespace scree::encoder {

std::optional<std::int64_t> read_signal(const EncoderSettings& layout,
                                        std::span<const std::uint8_t> data) {
  if (data.size() < static_cast<std::size_t>(layout.frame_bytes())) return std::nullopt;
  const bool is_little = layout.byte_order == ByteOrder::little_endian;
  std::uint64_t bits = 0;
  int place = layout.start_bit;
  for (int i = 0; i < layout.length; ++i) {
    const auto byte = data[static_cast<std::size_t>(place / 8)];
    const std::uint64_t bit = (byte >> static_cast<unsigned>(place % 8)) & 1U;
    if (is_little) {
      bits |= bit << static_cast<unsigned>(i);
      ++place;
    } else {
      bits = bits << 1U | bit;
      place += place % 8 == 0 ? 15 : -1;
    }
  }
  const auto unused = static_cast<unsigned>(64 - layout.length);
  if (layout.is_signed) return static_cast<std::int64_t>(bits << unused) >> unused;
  return static_cast<std::int64_t>(bits);
}

namespace {

double number_of(const EncoderSettings& layout, std::int64_t raw) {
  const auto bits = static_cast<std::uint64_t>(raw);
  if (layout.is_float && layout.length == 64) return std::bit_cast<double>(bits);
  if (layout.is_float) return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
  return layout.is_signed ? static_cast<double>(raw) : static_cast<double>(bits);
}

}  // namespace

double scaled(const EncoderSettings& layout, std::int64_t raw) {
  const double number = number_of(layout, raw);
  return (number * layout.factor + layout.offset) * layout.scale;
}

double quantum(const EncoderSettings& layout) {
  return layout.is_float ? 0 : std::abs(layout.factor * layout.scale);
}

}  // namespace scree::encoder
