#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <chrono>
#include <cstddef>
#include <vector>

#include "event.hpp"
#include "scree/core/queue_depth.hpp"

namespace scree {

/// A pool of items made beforehand, which pass through a queue from one producing to one consuming
/// thread. Nothing is copied, allocated or locked: the producer acquires a free item, fills it and
/// pushes it; the consumer pops it and releases it. When the consumer is too slow no item is free,
/// and the producer has to drop what is newest.
template <class Item>
class SpscPool {
public:
  /// `make` is called for each of the items.
  template <class Make>
  SpscPool(std::size_t items, Make&& make) : free_(items), full_(items), depth_(items) {
    items_.reserve(items);
    for (std::size_t i = 0; i < items; ++i) items_.push_back(make());
    for (Item& item : items_) free_.push(&item);
  }

  /// Producer: a free item to fill and push, or null when the consumer has all of them.
  Item* acquire() {
    Item* item = nullptr;
    free_.pop(item);
    return item;
  }
  /// Producer: passes a filled item to the consumer and wakes it.
  void push(Item* item) {
    depth_.put();
    full_.push(item);
    filled_.wake();
  }

  /// Consumer: the oldest filled item, or null when none waits.
  Item* pop() {
    Item* item = nullptr;
    full_.pop(item);
    return item;
  }
  /// Consumer: makes an item free again.
  void release(Item* item) {
    depth_.take();
    free_.push(item);
  }
  /// Consumer: sleeps until an item may wait, wake() was called or the time is over.
  void wait(std::chrono::milliseconds longest) { filled_.wait(longest); }

  /// Any thread: lets wait() return.
  void wake() { filled_.wake(); }
  /// Any thread: how many items are not free, those that the consumer works on with them.
  QueueFill fill() const { return depth_.fill(); }

private:
  std::vector<Item> items_;
  boost::lockfree::spsc_queue<Item*> free_, full_;
  QueueDepth depth_;
  Event filled_;
};

}  // namespace scree
