#include "simulator/byte_noise.hpp"

namespace scree {

void ByteNoise::pass(std::uint8_t byte, std::vector<std::uint8_t>& arrived) {
  if (!random_.chance(share_)) return arrived.push_back(byte);
  switch (random_.index(3)) {
    case 0:
      arrived.push_back(static_cast<std::uint8_t>(byte ^ 1U << random_.index(8)));
      break;
    case 1:
      arrived.push_back(byte);
      arrived.push_back(static_cast<std::uint8_t>(random_.next()));
      break;
    default:
      break;
  }
}

}  // namespace scree
