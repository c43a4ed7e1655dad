#include "scree/publish/message_decoder.hpp"

#include <utility>

#include "message_bounds.hpp"
#include "scree/publish/publisher.hpp"

namespace scree {

MessageDecoder::MessageDecoder(OnList on_list, OnHealth on_health, OnGrid on_grid)
    : on_list_(std::move(on_list)),
      on_health_(std::move(on_health)),
      on_grid_(std::move(on_grid)) {}

bool MessageDecoder::take(std::string_view channel, std::span<const std::uint8_t> data) {
  if (channel == kObstaclesChannel) {
    decode<obstacle_list_t>(data, is_obstacle_list(data), on_list_);
  } else if (channel == kHealthChannel) {
    decode<health_t>(data, is_health(data), on_health_);
  } else if (channel == kGridChannel && on_grid_) {
    decode<grid_t>(data, is_grid(data), on_grid_);
  } else {
    return false;
  }
  return true;
}

template <class Message, class Handler>
void MessageDecoder::decode(std::span<const std::uint8_t> data, bool is_sound,
                            const Handler& handler) {
  Message message{};
  // Fails on another type of the same channel, as of another version of Scree.
  if (!is_sound || message.decode(data.data(), 0, static_cast<int>(data.size())) < 0) {
    ++refused_;
    return;
  }
  handler(message);
}

}  // namespace scree
