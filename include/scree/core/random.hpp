#pragma once

#include <cstddef>
#include <cstdint>

namespace scree {

/// Random numbers that are the same on every machine for the same seed (the distributions of the
/// standard library are not). SplitMix64: Steele, Lea, Flood, OOPSLA 2014.
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  /// A stream of its own for each (seed, stream) pair.
  Random(std::uint64_t seed, std::uint64_t stream) : state_(seed) {
    state_ = next() ^ Random(stream).next();
  }

  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  }
  /// In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [0, count). @pre count > 0
  std::size_t index(std::size_t count) {
    return static_cast<std::size_t>(uniform() * static_cast<double>(count));
  }
  bool chance(double probability) { return uniform() < probability; }
  /// Mean 0, standard deviation 1, within +-6: the sum of twelve uniform numbers, because logarithm
  /// and cosine differ in the last bit from machine to machine.
  double normal() {
    std::uint64_t sum = 0;
    for (int i = 0; i < 3; ++i) {
      const std::uint64_t bits = next();
      for (unsigned shift = 0; shift < 64; shift += 16) sum += (bits >> shift) & 0xFFFFU;
    }
    return (static_cast<double>(sum) + 6.0) * 0x1.0p-16 - 6.0;
  }

private:
  std::uint64_t state_;
};

}  // namespace scree
