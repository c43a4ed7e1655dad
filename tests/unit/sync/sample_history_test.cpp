#include "scree/sync/sample_history.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>

namespace scree {
namespace {

struct Stamp {
  std::int64_t t_ns = 0;
};

TEST(SampleHistory, IsADequeOfTheNewestInOrder) {
  SampleHistory<Stamp> history(7);
  std::deque<std::int64_t> reference;
  std::mt19937 random(3);
  for (int i = 0; i < 3000; ++i) {
    if (i % 500 == 499) {
      history.clear();
      reference.clear();
    }
    const std::int64_t newest = reference.empty() ? 0 : reference.back();
    const std::int64_t t_ns = newest + static_cast<std::int64_t>(random() % 5) - 1;
    const bool is_newer = reference.empty() || t_ns > newest;
    EXPECT_EQ(history.push({t_ns}), is_newer);
    if (is_newer) reference.push_back(t_ns);
    if (reference.size() > 7) reference.pop_front();

    ASSERT_EQ(history.size(), reference.size());
    for (std::size_t k = 0; k < reference.size(); ++k) ASSERT_EQ(history[k].t_ns, reference[k]);
    if (!reference.empty()) {
      ASSERT_EQ(history.newest().t_ns, reference.back());
    }
    const std::int64_t asked = newest - 12 + static_cast<std::int64_t>(random() % 16);
    const auto until = std::upper_bound(reference.begin(), reference.end(), asked);
    ASSERT_EQ(history.count_until(asked), static_cast<std::size_t>(until - reference.begin()));
  }
}

}  // namespace
}  // namespace scree
