#include "scree/publish/subscriber.hpp"

#include <poll.h>
#include <sys/select.h>
#include <sys/socket.h>

#include <cerrno>
#include <utility>

#include "lcm_datagrams.hpp"
#include "scree/core/socket_message.hpp"
#include "scree/publish/multicast.hpp"
#include "scree/publish/publisher.hpp"

namespace scree {
namespace {

/// liblcm waits with select(), which writes beyond its memory for any other descriptor.
bool can_wait_for(lcm_t* lcm) {
  const int descriptor = lcm_get_fileno(lcm);
  return descriptor >= 0 && descriptor < FD_SETSIZE;
}

}  // namespace

Result<std::unique_ptr<Subscriber>> Subscriber::open(const std::string& lcm_url, OnList on_list,
                                                     OnHealth on_health, OnGrid on_grid) {
  if (const auto routed = check_multicast(lcm_url); !routed) {
    return tl::make_unexpected(routed.error());
  }
  std::unique_ptr<Subscriber> subscriber(
      new Subscriber(std::move(on_list), std::move(on_health), std::move(on_grid)));
  if (is_multicast(lcm_url)) {
    auto socket = listen_to_group(lcm_url);
    if (!socket) return tl::make_unexpected(socket.error());
    subscriber->socket_ = std::move(*socket);
  } else {
    auto lcm = open_lcm(lcm_url);
    if (!lcm) return tl::make_unexpected(lcm.error());
    subscriber->lcm_ = std::move(*lcm);
    if (!subscriber->subscribe()) return fail("LCM cannot subscribe at " + lcm_url);
  }
  return subscriber;
}

Subscriber::Subscriber(OnList on_list, OnHealth on_health, OnGrid on_grid)
    : datagrams_(std::make_unique<LcmDatagrams>()),
      buffer_(1 << 16),  // the longest datagram
      decoder_(std::move(on_list), std::move(on_health), std::move(on_grid)) {}

Subscriber::~Subscriber() = default;

/// LCM's C interface is used here: lcm-cpp calls subscriptions through a pointer to a member, which
/// trips the undefined-behaviour sanitizer.
bool Subscriber::subscribe() {
  if (!can_wait_for(lcm_.get())) return false;
  const auto on_message = [](const lcm_recv_buf_t* buffer, const char* channel, void* subscriber) {
    const auto* data = static_cast<const std::uint8_t*>(buffer->data);
    static_cast<Subscriber*>(subscriber)->decoder_.take(channel, {data, buffer->data_size});
  };
  for (const std::string_view channel : {kObstaclesChannel, kHealthChannel, kGridChannel}) {
    if (lcm_subscribe(lcm_.get(), channel.data(), on_message, this) == nullptr) return false;
  }
  return true;
}

bool Subscriber::handle(int milliseconds) {
  if (socket_.is_open()) return handle_datagrams(milliseconds);
  if (!can_wait_for(lcm_.get())) return false;
  errno = 0;
  return lcm_handle_timeout(lcm_.get(), milliseconds) >= 0 || errno == EINTR;
}

bool Subscriber::handle_datagrams(int milliseconds) {
  pollfd wait_for{socket_.get(), POLLIN, 0};
  if (poll(&wait_for, 1, milliseconds) < 0) return errno == EINTR;
  constexpr int kMost = 1000;  // without a message in them the caller gets its turn
  for (int i = 0; i < kMost; ++i) {
    std::uint32_t drops = 0;
    const SocketMessage received = receive_message(socket_.get(), buffer_, drops);
    if (received.size < 0) return errno == EAGAIN || errno == EWOULDBLOCK;
    const std::uint64_t sender = std::uint64_t{received.sender.sin_addr.s_addr} << 16U |
                                 std::uint64_t{received.sender.sin_port};
    const auto message =
        datagrams_->take({buffer_.data(), static_cast<std::size_t>(received.size)}, sender);
    if (message && decoder_.take(message->channel, message->data)) return true;
  }
  return true;
}

std::uint64_t Subscriber::refused() const {
  return decoder_.refused() + datagrams_->refused();
}

}  // namespace scree
