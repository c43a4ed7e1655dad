#include "fragments.hpp"

#include <algorithm>
#include <utility>

namespace scree {
namespace {

constexpr std::size_t kHeader = 20;  // bytes, without options
constexpr std::size_t kLengthAt = 2, kFlagsAt = 6;

std::size_t u16_at(std::span<const std::uint8_t> bytes, std::size_t offset) {
  return std::size_t{bytes[offset]} << 8U | bytes[offset + 1];
}

}  // namespace

Fragments::Partial& Fragments::partial_of(std::span<const std::uint8_t> packet) {
  std::array<std::uint8_t, 11> key{};
  std::copy_n(packet.begin() + 12, 8, key.begin());
  std::copy_n(packet.begin() + 4, 2, key.begin() + 8);
  key[10] = packet[9];
  const auto known = std::ranges::find_if(partials_, [&](const Partial& partial) {
    return partial.fragments > 0 && partial.key == key;
  });
  if (known != partials_.end()) return *known;
  Partial& free = *std::ranges::min_element(partials_, {}, [](const Partial& partial) {
    return partial.fragments == 0 ? 0 : partial.begun;
  });
  free.key = key;
  free.fragments = 0;
  free.begun = ++begun_;
  free.size = 0;
  free.bytes.assign(kHeader, 0);
  free.there.reset();
  return free;
}

std::optional<Fragments::Whole> Fragments::take(std::span<const std::uint8_t> packet) {
  if (packet.size() < kHeader) return std::nullopt;
  const std::size_t header = (packet[0] & std::size_t{0x0F}) * 4;
  const std::size_t length = u16_at(packet, kLengthAt), flags = u16_at(packet, kFlagsAt);
  if (header < kHeader || length <= header || length > packet.size()) return std::nullopt;
  const std::size_t offset = (flags & 0x1FFFU) * kUnit, size = length - header;
  const bool is_last = (flags & 0x2000U) == 0;
  if (offset + size > kLongest - kHeader || (!is_last && size % kUnit != 0)) return std::nullopt;

  Partial& partial = partial_of(packet);
  ++partial.fragments;
  partial.bytes.resize(std::max(partial.bytes.size(), kHeader + offset + size));
  std::copy_n(packet.begin() + static_cast<std::ptrdiff_t>(header), size,
              partial.bytes.begin() + static_cast<std::ptrdiff_t>(kHeader + offset));
  for (std::size_t at = offset; at < offset + size; at += kUnit) partial.there.set(at / kUnit);
  if (offset == 0) std::copy_n(packet.begin(), kHeader, partial.bytes.begin());
  if (is_last) partial.size = offset + size;
  const std::size_t units = (partial.size + kUnit - 1) / kUnit;
  if (units == 0 || partial.there.count() < units) return std::nullopt;

  whole_.swap(partial.bytes);
  const std::uint64_t fragments = std::exchange(partial.fragments, 0);
  whole_.resize(kHeader + partial.size);
  whole_[0] = 0x45;  // without the options
  whole_[kLengthAt] = static_cast<std::uint8_t>(whole_.size() >> 8U);
  whole_[kLengthAt + 1] = static_cast<std::uint8_t>(whole_.size());
  whole_[kFlagsAt] = whole_[kFlagsAt + 1] = 0;
  return Whole{whole_, fragments};
}

}  // namespace scree
