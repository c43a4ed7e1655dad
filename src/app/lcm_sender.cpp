#include "lcm_sender.hpp"

#include <pthread.h>

#include <thread>
#include <utility>

#include "keeper.hpp"
#include "loop_counter.hpp"

namespace scree {
namespace {

// Two sweeps with list, grid and health, and as much again.
constexpr std::size_t kWaiting = 12;

}  // namespace

std::shared_ptr<LcmSender> LcmSender::start(Publisher publisher, std::size_t max_obstacles,
                                            Keeper* keeper) {
  std::shared_ptr<LcmSender> sender(new LcmSender(std::move(publisher), max_obstacles, keeper));
  std::thread thread([sender] { sender->run(); });
  pthread_setname_np(thread.native_handle(), "lcm");
  thread.detach();
  return sender;
}

LcmSender::LcmSender(Publisher publisher, std::size_t max_obstacles, Keeper* keeper)
    : publisher_(std::move(publisher)),
      encoder_(max_obstacles),
      keeper_(keeper),
      waiting_(kWaiting, [this] {
        Outgoing outgoing;
        outgoing.message.bytes.reserve(encoder_.longest());
        return outgoing;
      }) {
  dropped_.bytes.reserve(encoder_.longest());
}

void LcmSender::put(const ObstacleList& list, std::int64_t data_ns) {
  put(list, data_ns, failed_);
}

void LcmSender::put(const ObstacleGrid& grid) {
  put(grid, 0, failed_);
}

bool LcmSender::put(const health_t& health) {
  return put(health, 0, health_failed_);
}

template <class Message>
bool LcmSender::put(const Message& message, std::int64_t data_ns,
                    std::atomic<std::uint64_t>& failed) {
  Outgoing* const outgoing = waiting_.acquire();
  if (outgoing == nullptr) failed.fetch_add(1, std::memory_order_relaxed);
  if (outgoing == nullptr && keeper_ == nullptr) return false;
  EncodedMessage& encoded = outgoing != nullptr ? outgoing->message : dropped_;
  encoder_.encode(message, encoded);
  if (keeper_ != nullptr) keeper_->put(encoded.channel, encoded.bytes);
  if (outgoing == nullptr) return false;
  outgoing->data_ns = data_ns;
  waiting_.push(outgoing);
  return true;
}

LcmSender::Counts LcmSender::counts() const {
  return {lists_.load(std::memory_order_relaxed), failed_.load(std::memory_order_relaxed),
          health_failed_.load(std::memory_order_relaxed),
          last_list_ns_.load(std::memory_order_relaxed)};
}

bool LcmSender::finish(std::chrono::milliseconds longest) {
  is_stopped_ = true;
  waiting_.wake();
  return done_.wait(longest);
}

void LcmSender::run() {
  bool is_last = false;
  while (!is_last) {
    is_last = is_stopped_;  // asked first: what was put before finish() is still sent
    while (Outgoing* outgoing = waiting_.pop()) {
      send(*outgoing);
      waiting_.release(outgoing);
    }
    if (!is_last) waiting_.wait(std::chrono::milliseconds(kMaxWaitMs));
  }
  done_.wake();
}

void LcmSender::send(const Outgoing& outgoing) {
  const bool is_taken = publisher_.send(outgoing.message);
  const bool is_health = outgoing.message.channel == kHealthChannel;
  if (!is_taken) (is_health ? health_failed_ : failed_).fetch_add(1, std::memory_order_relaxed);
  if (!is_taken || outgoing.message.channel != kObstaclesChannel) return;
  lists_.fetch_add(1, std::memory_order_relaxed);
  last_list_ns_.store(outgoing.data_ns, std::memory_order_relaxed);
}

}  // namespace scree
