#include "scree/publish/lcm_event.hpp"

namespace scree {

void append_lcm_event(std::int64_t number, std::int64_t time_us, std::string_view channel,
                      std::span<const std::uint8_t> message, std::vector<std::uint8_t>& log) {
  constexpr std::uint64_t kMagic = 0xEDA1DA01;
  const auto put = [&](std::uint64_t value, int bytes) {  // big-endian
    for (int i = bytes - 1; i >= 0; --i) {
      log.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xFF));
    }
  };
  put(kMagic, 4);
  put(static_cast<std::uint64_t>(number), 8);
  put(static_cast<std::uint64_t>(time_us), 8);
  put(channel.size(), 4);
  put(message.size(), 4);
  log.insert(log.end(), channel.begin(), channel.end());
  log.insert(log.end(), message.begin(), message.end());
}

}  // namespace scree
