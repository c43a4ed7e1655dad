#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// Sorts cell keys with the index of the point behind each, in memory taken once. A key and its
/// index share one 64-bit word, key above, so equal keys come out in the order of their indices.
class KeySort {
public:
  explicit KeySort(std::size_t capacity);

  /// Bits that are left for a key beside an index of `capacity` points.
  static int key_bits(std::size_t capacity) {
    return 64 - static_cast<int>(std::bit_width(capacity));
  }

  void clear() { words_.clear(); }
  /// @pre key < 2^key_bits(capacity), index < capacity, fewer than capacity pushed
  void push(std::uint64_t key, std::size_t index) { words_.push_back(key << index_bits_ | index); }
  void sort();

  std::size_t size() const { return words_.size(); }
  std::uint64_t key(std::size_t i) const { return words_[i] >> index_bits_; }
  std::uint32_t index(std::size_t i) const {
    return static_cast<std::uint32_t>(words_[i] & ((std::uint64_t{1} << index_bits_) - 1));
  }

private:
  int index_bits_;
  FixedVector<std::uint64_t> words_, other_;
};

}  // namespace scree
