#include "scree/publish/subscriber.hpp"

#include <cerrno>
#include <utility>

#include "scree/publish/multicast.hpp"
#include "scree/publish/publisher.hpp"

namespace scree {

// LCM's C interface is used here: lcm-cpp calls subscriptions through a pointer to a member, which
// trips the undefined-behaviour sanitizer.

Result<std::unique_ptr<Subscriber>> Subscriber::open(const std::string& lcm_url, OnList on_list,
                                                     OnHealth on_health, OnGrid on_grid) {
  if (const auto routed = check_multicast(lcm_url); !routed) {
    return tl::make_unexpected(routed.error());
  }
  lcm_t* lcm = lcm_create(lcm_url.c_str());
  if (lcm == nullptr) return fail("LCM cannot open " + lcm_url);
  return std::unique_ptr<Subscriber>(
      new Subscriber(lcm, std::move(on_list), std::move(on_health), std::move(on_grid)));
}

Subscriber::Subscriber(lcm_t* lcm, OnList on_list, OnHealth on_health, OnGrid on_grid)
    : lcm_(lcm),
      on_list_(std::move(on_list)),
      on_health_(std::move(on_health)),
      on_grid_(std::move(on_grid)) {
  lcm_subscribe(lcm, kObstaclesChannel, take<obstacle_list_t, OnList, &Subscriber::on_list_>, this);
  lcm_subscribe(lcm, kHealthChannel, take<health_t, OnHealth, &Subscriber::on_health_>, this);
  if (!on_grid_) return;
  lcm_subscribe(lcm, kGridChannel, take<grid_t, OnGrid, &Subscriber::on_grid_>, this);
}

bool Subscriber::handle(int milliseconds) {
  errno = 0;
  return lcm_handle_timeout(lcm_.get(), milliseconds) >= 0 || errno == EINTR;
}

template <class Message, class Handler, Handler Subscriber::*handler>
void Subscriber::take(const lcm_recv_buf_t* buffer, const char*, void* subscriber) {
  Message message{};
  // Fails on another type of the same channel, as of another version of Scree.
  if (message.decode(buffer->data, 0, static_cast<int>(buffer->data_size)) < 0) return;
  (static_cast<Subscriber*>(subscriber)->*handler)(message);
}

}  // namespace scree
