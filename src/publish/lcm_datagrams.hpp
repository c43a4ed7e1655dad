#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace scree {

/// A message of an LCM channel. It lies in the datagram that it came in, or in the memory of what
/// put it together until the next call.
struct LcmMessage {
  std::string_view channel;
  std::span<const std::uint8_t> data;
};

/// Makes messages of LCM's datagrams (lcm 1.4, udpm_util.h), which may come in fragments. liblcm
/// writes beyond its memory where a fragment lies; here any bytes are safe, and a message takes no
/// more memory than what has come of it.
class LcmDatagrams {
public:
  static constexpr std::size_t kLongestMessage = 32 << 20;  ///< bytes; longer ones are refused

  /// @param sender tells the senders of fragments apart
  std::optional<LcmMessage> take(std::span<const std::uint8_t> datagram, std::uint64_t sender);

  /// Datagrams that are none of LCM's, or fragments that do not follow the one before.
  std::uint64_t refused() const { return refused_; }

private:
  struct Partial {
    std::uint64_t sender = 0;
    std::uint32_t sequence = 0, size = 0;  // size 0: free
    std::uint64_t begun = 0;
    std::vector<char> channel;
    std::vector<std::uint8_t> data;
  };

  std::optional<LcmMessage> take_whole(std::span<const std::uint8_t> datagram);
  std::optional<LcmMessage> take_fragment(std::span<const std::uint8_t> datagram,
                                          std::uint64_t sender);
  Partial* partial_of(std::uint64_t sender, std::uint32_t sequence);
  std::optional<LcmMessage> refuse();

  std::array<Partial, 8> partials_;
  std::uint64_t begun_ = 0, refused_ = 0;
};

}  // namespace scree
