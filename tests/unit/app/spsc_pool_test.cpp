#include "app/spsc_pool.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <thread>

namespace scree {
namespace {

struct Item {
  std::uint64_t number = 0;
};

Item make_item() {
  return {};
}

TEST(SpscPool, WhenFullNothingIsFreeUntilOneIsReleased) {
  SpscPool<Item> pool(2, make_item);
  for (std::uint64_t i = 1; i <= 2; ++i) {
    Item* item = pool.acquire();
    ASSERT_NE(item, nullptr);
    item->number = i;
    pool.push(item);
  }
  EXPECT_EQ(pool.acquire(), nullptr);
  EXPECT_EQ(pool.fill().waiting, 2U);
  Item* oldest = pool.pop();
  ASSERT_NE(oldest, nullptr);
  EXPECT_EQ(oldest->number, 1U);
  EXPECT_EQ(pool.acquire(), nullptr) << "the consumer still works on it";
  pool.release(oldest);
  EXPECT_EQ(pool.acquire(), oldest);
  EXPECT_EQ(pool.pop()->number, 2U);
  EXPECT_EQ(pool.pop(), nullptr);
  EXPECT_EQ(pool.fill().waiting, 1U) << "the one that is worked on";
  EXPECT_EQ(pool.fill().most, 2U);
  EXPECT_EQ(pool.fill().capacity, 2U);
}

TEST(SpscPool, AWakeUpBeforeTheWaitIsNotLost) {
  SpscPool<Item> pool(1, make_item);
  pool.wake();
  pool.wait(std::chrono::milliseconds(60'000));
}

TEST(SpscPool, EverythingPushedArrivesOnceAndInOrder) {
  constexpr std::uint64_t kItems = 20'000;
  SpscPool<std::unique_ptr<Item>> pool(3, [] { return std::make_unique<Item>(); });
  std::jthread producer([&] {
    for (std::uint64_t i = 1; i <= kItems;) {
      std::unique_ptr<Item>* item = pool.acquire();
      if (item == nullptr) {
        std::this_thread::yield();
        continue;
      }
      (*item)->number = i++;
      pool.push(item);
    }
  });
  // A third thread, as the one that publishes health.
  std::jthread watcher([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const QueueFill fill = pool.fill();
      EXPECT_LE(fill.waiting, 3U);
      EXPECT_LE(fill.most, 3U);
      std::this_thread::yield();
    }
  });
  for (std::uint64_t expected = 1; expected <= kItems;) {
    std::unique_ptr<Item>* item = pool.pop();
    if (item == nullptr) {
      pool.wait(std::chrono::milliseconds(60'000));
      continue;
    }
    ASSERT_EQ((*item)->number, expected++);
    pool.release(item);
  }
}

}  // namespace
}  // namespace scree
