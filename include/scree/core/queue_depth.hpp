#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace scree {

/// How full a ring is.
struct QueueFill {
  std::size_t waiting = 0;  ///< items in it, now
  std::size_t most = 0;     ///< that have waited at once since the start
  std::size_t capacity = 0;
};

/// Follows how full a ring between one producing and one consuming thread is.
class QueueDepth {
public:
  explicit QueueDepth(std::size_t capacity) : capacity_(capacity) {}

  /// Producer: before it puts an item in.
  void put() {
    const std::uint64_t put = put_.load(std::memory_order_relaxed) + 1;
    put_.store(put, std::memory_order_release);
    const std::uint64_t waiting = put - taken_.load(std::memory_order_relaxed);
    if (waiting > most_.load(std::memory_order_relaxed)) {
      most_.store(waiting, std::memory_order_relaxed);
    }
  }
  /// Consumer: after it took an item out.
  void take() {
    taken_.store(taken_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  /// Any thread. An item that is just on its way in or out counts as waiting.
  QueueFill fill() const {
    // In this order: what was taken has been put before.
    const std::uint64_t taken = taken_.load(std::memory_order_acquire);
    const std::uint64_t put = put_.load(std::memory_order_acquire);
    const auto in_range = [this](std::uint64_t items) {
      return std::min<std::size_t>(items, capacity_);
    };
    return {in_range(put - taken), in_range(most_.load(std::memory_order_relaxed)), capacity_};
  }

private:
  std::size_t capacity_;
  std::atomic<std::uint64_t> put_{0}, taken_{0}, most_{0};
};

}  // namespace scree
