#include "scree/detect/key_sort.hpp"

#include <array>
#include <utility>

namespace scree {

KeySort::KeySort(std::size_t capacity)
    : index_bits_(64 - key_bits(capacity)), words_(capacity), other_(capacity) {}

// A radix sort from the least digit of the key upwards. Digits in which no two keys differ are
// skipped. Where indices were pushed in their order, the lower bits are sorted already.
void KeySort::sort() {
  constexpr int kDigitBits = 11;  // its 2048 counts fit into the first cache of any processor
  constexpr std::uint64_t kDigitMask = (1U << kDigitBits) - 1;
  std::uint64_t differing = 0;
  bool ascending_indices = true;
  for (std::size_t i = 1; i < size(); ++i) {
    differing |= words_[i] ^ words_[0];
    ascending_indices = ascending_indices && index(i - 1) < index(i);
  }
  other_.resize(size());
  for (int shift = ascending_indices ? index_bits_ : 0; shift < 64; shift += kDigitBits) {
    if ((differing >> shift & kDigitMask) == 0) continue;
    std::array<std::uint32_t, kDigitMask + 1> start{};
    for (const std::uint64_t word : words_) ++start[word >> shift & kDigitMask];
    std::uint32_t sum = 0;
    for (std::uint32_t& count : start) sum += std::exchange(count, sum);
    for (const std::uint64_t word : words_) other_[start[word >> shift & kDigitMask]++] = word;
    std::swap(words_, other_);
  }
}

}  // namespace scree
