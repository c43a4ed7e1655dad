// The weights of a network. One that is accepted gives probabilities.
#include <cmath>
#include <vector>

#include "memory_file.hpp"
#include "scree/detect/network.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  const auto network = scree::Network::parse(text, "fuzz");
  scree::fuzz::require(network.has_value() || !network.error().message.empty());
  return 0;
}
