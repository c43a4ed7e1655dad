#pragma once

#include <cstdint>
#include <vector>

#include "scree/core/random.hpp"

namespace scree {

/// A serial line that disturbs a share of its bytes: a bit is flipped, the byte is lost, or it is
/// followed by one that nobody sent, each as often.
class ByteNoise {
public:
  explicit ByteNoise(std::uint64_t seed, double share = 0) : random_(seed, 0x5E42), share_(share) {}

  void set_share(double share) { share_ = share; }
  /// Appends what arrives of a byte.
  void pass(std::uint8_t byte, std::vector<std::uint8_t>& arrived);

private:
  Random random_;
  double share_;
};

}  // namespace scree
