#include "app/triple_buffer.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <thread>

namespace scree {
namespace {

TEST(TripleBuffer, BeforeTheFirstItIsADefaultOne) {
  TripleBuffer<int> buffer;
  EXPECT_EQ(buffer.get(), 0);
}

TEST(TripleBuffer, GivesTheNewestAndKeepsIt) {
  TripleBuffer<int> buffer;
  for (int i = 1; i < 10; ++i) buffer.put(i);
  EXPECT_EQ(buffer.get(), 9);
  EXPECT_EQ(buffer.get(), 9);
  buffer.put(10);
  EXPECT_EQ(buffer.get(), 10);
}

TEST(TripleBuffer, ValuesAreNeverTornAndNeverGoBack) {
  struct Pair {
    std::uint64_t first = 0, second = 0;
  };
  constexpr std::uint64_t kValues = 100'000;
  TripleBuffer<Pair> buffer;
  std::jthread writer([&] {
    for (std::uint64_t i = 1; i <= kValues; ++i) buffer.put({i, ~i});
  });
  std::uint64_t last = 0;
  while (last < kValues) {
    const Pair& pair = buffer.get();
    ASSERT_TRUE(pair.first == 0 || pair.second == ~pair.first);
    ASSERT_GE(pair.first, last);
    last = pair.first;
  }
}

}  // namespace
}  // namespace scree
