#include "app/hand_over.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "app/latest.hpp"

namespace scree {
namespace {

struct Item {
  std::uint64_t number = 0;
};

Item make_item() {
  return {};
}

TEST(HandOver, WhenFullNothingIsFreeUntilOneIsGivenBack) {
  HandOver<Item> ring(2, make_item);
  for (std::uint64_t i = 1; i <= 2; ++i) {
    Item* item = ring.take_free();
    ASSERT_NE(item, nullptr);
    item->number = i;
    ring.hand_over(item);
  }
  EXPECT_EQ(ring.take_free(), nullptr);
  EXPECT_EQ(ring.fill().waiting, 2U);
  Item* oldest = ring.take_full();
  ASSERT_NE(oldest, nullptr);
  EXPECT_EQ(oldest->number, 1U);
  EXPECT_EQ(ring.take_free(), nullptr) << "the consumer still works on it";
  ring.give_back(oldest);
  EXPECT_EQ(ring.take_free(), oldest);
  EXPECT_EQ(ring.take_full()->number, 2U);
  EXPECT_EQ(ring.take_full(), nullptr);
  EXPECT_EQ(ring.fill().waiting, 1U) << "the one that is worked on";
  EXPECT_EQ(ring.fill().most, 2U);
  EXPECT_EQ(ring.fill().capacity, 2U);
}

TEST(HandOver, AWakeUpBeforeTheWaitIsNotLost) {
  HandOver<Item> ring(1, make_item);
  ring.wake();
  ring.wait(std::chrono::milliseconds(60'000));
}

TEST(HandOver, EverythingHandedOverArrivesOnceAndInOrder) {
  constexpr std::uint64_t kItems = 20'000;
  HandOver<std::unique_ptr<Item>> ring(3, [] { return std::make_unique<Item>(); });
  std::jthread producer([&] {
    for (std::uint64_t i = 1; i <= kItems;) {
      std::unique_ptr<Item>* item = ring.take_free();
      if (item == nullptr) {
        std::this_thread::yield();
        continue;
      }
      (*item)->number = i++;
      ring.hand_over(item);
    }
  });
  // A third thread, as the one that publishes health.
  std::jthread watcher([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const QueueFill fill = ring.fill();
      EXPECT_LE(fill.waiting, 3U);
      EXPECT_LE(fill.most, 3U);
      std::this_thread::yield();
    }
  });
  for (std::uint64_t expected = 1; expected <= kItems;) {
    std::unique_ptr<Item>* item = ring.take_full();
    if (item == nullptr) {
      ring.wait(std::chrono::milliseconds(60'000));
      continue;
    }
    ASSERT_EQ((*item)->number, expected++);
    ring.give_back(item);
  }
}

TEST(Latest, BeforeTheFirstItIsADefaultOne) {
  Latest<Item> latest;
  EXPECT_EQ(latest.get().number, 0U);
}

TEST(Latest, GivesTheNewestAndKeepsIt) {
  Latest<Item> latest;
  for (std::uint64_t i = 1; i < 10; ++i) latest.put({i});
  EXPECT_EQ(latest.get().number, 9U);
  EXPECT_EQ(latest.get().number, 9U);
  latest.put({10});
  EXPECT_EQ(latest.get().number, 10U);
}

TEST(Latest, ValuesAreNeverTornAndNeverGoBack) {
  struct Pair {
    std::uint64_t first = 0, second = 0;
  };
  constexpr std::uint64_t kValues = 100'000;
  Latest<Pair> latest;
  std::jthread writer([&] {
    for (std::uint64_t i = 1; i <= kValues; ++i) latest.put({i, ~i});
  });
  std::uint64_t last = 0;
  while (last < kValues) {
    const Pair& pair = latest.get();
    ASSERT_TRUE(pair.first == 0 || pair.second == ~pair.first);
    ASSERT_GE(pair.first, last);
    last = pair.first;
  }
}

}  // namespace
}  // namespace scree
