#include "scree/publish/publisher.hpp"

#include <algorithm>

#include "scree/publish/messages.hpp"
#include "scree/publish/multicast.hpp"

namespace scree {

Result<Publisher> Publisher::open(const std::string& lcm_url, std::size_t max_obstacles) {
  if (const auto routed = check_multicast(lcm_url); !routed) {
    return tl::make_unexpected(routed.error());
  }
  lcm_t* lcm = lcm_create(lcm_url.c_str());
  if (lcm == nullptr) return fail("LCM cannot open " + lcm_url);
  return Publisher(lcm, max_obstacles);
}

Publisher::Publisher(lcm_t* lcm, std::size_t max_obstacles) : lcm_(lcm) {
  make_room(max_obstacles, list_);
  make_room(grid_);
  encoded_.resize(
      static_cast<std::size_t>(std::max(list_.getEncodedSize(), grid_.getEncodedSize())));
}

bool Publisher::publish(const ObstacleList& list) {
  to_message(list, list_);
  return send(kObstaclesChannel, list_);
}

bool Publisher::publish(const ObstacleGrid& grid) {
  to_message(grid, grid_);
  return send(kGridChannel, grid_);
}

bool Publisher::publish(const health_t& health) {
  return send(kHealthChannel, health);
}

template <class Message>
bool Publisher::send(const char* channel, const Message& message) {
  const auto size = static_cast<std::size_t>(message.getEncodedSize());
  if (encoded_.size() < size) encoded_.resize(size);
  const int encoded = message.encode(encoded_.data(), 0, static_cast<int>(size));
  last_size_ = static_cast<std::size_t>(std::max(encoded, 0));
  return encoded >= 0 &&
         lcm_publish(lcm_.get(), channel, encoded_.data(), static_cast<unsigned int>(encoded)) == 0;
}

}  // namespace scree
