#pragma once

#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// The newest samples of one sensor in the order of their times; the oldest make room for new ones.
template <class Sample>
class SampleHistory {
public:
  explicit SampleHistory(std::size_t capacity) : ring_(capacity) { ring_.resize(capacity); }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// From the oldest on.
  const Sample& operator[](std::size_t i) const { return ring_[(first_ + i) % ring_.capacity()]; }
  const Sample& newest() const { return (*this)[size_ - 1]; }

  /// False when the sample is not newer than the newest; it is then not taken.
  bool push(const Sample& sample) {
    if (!empty() && sample.t_ns <= newest().t_ns) return false;
    if (size_ == ring_.capacity()) {
      first_ = (first_ + 1) % ring_.capacity();
      --size_;
    }
    ring_[(first_ + size_++) % ring_.capacity()] = sample;
    return true;
  }
  void clear() { first_ = size_ = 0; }

  /// How many samples are not newer than a time: the next one, if any, is at that index.
  std::size_t count_until(std::int64_t t_ns) const {
    std::size_t low = 0, high = size_;
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if ((*this)[middle].t_ns <= t_ns) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }

private:
  FixedVector<Sample> ring_;
  std::size_t first_ = 0, size_ = 0;
};

}  // namespace scree
