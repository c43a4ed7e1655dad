#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <chrono>
#include <cstddef>
#include <vector>

#include "event.hpp"
#include "scree/core/queue_depth.hpp"

namespace scree {

/// A ring of items made beforehand, between one producing and one consuming thread. Nothing is
/// copied, allocated or locked: the producer fills a free item and hands it over, the consumer
/// gives it back. When the consumer is too slow there is no free item, and the newest is the one to
/// drop.
template <class Item>
class HandOver {
public:
  /// `make` is called for each of the items.
  template <class Make>
  HandOver(std::size_t items, Make&& make) : free_(items), full_(items), depth_(items) {
    items_.reserve(items);
    for (std::size_t i = 0; i < items; ++i) items_.push_back(make());
    for (Item& item : items_) free_.push(&item);
  }

  /// Producer: an item to fill and hand over, or null when the consumer holds all of them.
  Item* take_free() {
    Item* item = nullptr;
    free_.pop(item);
    return item;
  }
  /// Producer: passes a filled item on and wakes the consumer.
  void hand_over(Item* item) {
    depth_.put();
    full_.push(item);
    filled_.wake();
  }

  /// Consumer: the oldest filled item, or null when none waits.
  Item* take_full() {
    Item* item = nullptr;
    full_.pop(item);
    return item;
  }
  /// Consumer: done with the item.
  void give_back(Item* item) {
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
