#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace scree {

/// Puts the fragments of IPv4 packets together (RFC 791, section 3.2), in whatever order they come.
/// Bounded: where a packet more begins than there is room for, the oldest is given up.
class Fragments {
public:
  struct Whole {
    std::span<const std::uint8_t> packet;  ///< with the header of its first fragment, unfragmented
    std::uint64_t fragments;               ///< that it came in
  };
  /// Takes one fragment, an IPv4 packet by itself. The whole packet, when this is the last of it,
  /// lies here until the next call. Any bytes are safe.
  std::optional<Whole> take(std::span<const std::uint8_t> packet);

private:
  static constexpr std::size_t kLongest = 65535, kUnit = 8;

  struct Partial {
    std::array<std::uint8_t, 11> key{};  // addresses, identification, protocol
    std::uint64_t fragments = 0;         // 0: free
    std::uint64_t begun = 0;             // counts packets
    std::size_t size = 0;                // of the payload, known from the last fragment; 0: not yet
    std::vector<std::uint8_t> bytes;     // header, then the payload
    std::bitset<kLongest / kUnit + 1> there;
  };

  Partial& partial_of(std::span<const std::uint8_t> packet);

  std::array<Partial, 8> partials_;
  std::uint64_t begun_ = 0;
  std::vector<std::uint8_t> whole_;
};

}  // namespace scree
