#include "scree/publish/publisher.hpp"

#include <algorithm>
#include <utility>

#include "scree/publish/messages.hpp"
#include "scree/publish/multicast.hpp"

namespace scree {
namespace {

template <class Message>
void encode_on(std::string_view channel, const Message& message, EncodedMessage& encoded) {
  encoded.channel = channel;
  encoded.bytes.resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(encoded.bytes.data(), 0, static_cast<int>(encoded.bytes.size()));
}

}  // namespace

MessageEncoder::MessageEncoder(std::size_t max_obstacles) {
  make_room(max_obstacles, list_);
  make_room(grid_);
  longest_ = static_cast<std::size_t>(std::max(list_.getEncodedSize(), grid_.getEncodedSize()));
}

void MessageEncoder::encode(const ObstacleList& list, EncodedMessage& encoded) {
  to_message(list, list_);
  encode_on(kObstaclesChannel, list_, encoded);
}

void MessageEncoder::encode(const ObstacleGrid& grid, EncodedMessage& encoded) {
  to_message(grid, grid_);
  encode_on(kGridChannel, grid_, encoded);
}

void MessageEncoder::encode(const health_t& health, EncodedMessage& encoded) {
  encode_on(kHealthChannel, health, encoded);
}

Result<Publisher> Publisher::open(const std::string& lcm_url) {
  if (const auto routed = check_multicast(lcm_url); !routed) {
    return tl::make_unexpected(routed.error());
  }
  return open_lcm(lcm_url).map([](LcmHandle lcm) { return Publisher(std::move(lcm)); });
}

bool Publisher::send(const EncodedMessage& message) {
  return lcm_publish(lcm_.get(), message.channel.data(), message.bytes.data(),
                     static_cast<unsigned int>(message.bytes.size())) == 0;
}

}  // namespace scree
