#pragma once

#include <cstdint>
#include <string>

namespace scree {

/// An IPv4 address as people write it, 192.168.1.201. @param address in host byte order
inline std::string ipv4_text(std::uint32_t address) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) {
    text += std::to_string(address >> shift & 0xFF);
    if (shift > 0) text += '.';
  }
  return text;
}

}  // namespace scree
