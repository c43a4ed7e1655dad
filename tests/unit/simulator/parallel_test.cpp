#include "simulator/parallel.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace scree {
namespace {

TEST(Parallel, DoesEachOnceAndCountsThem) {
  std::vector<int> times(100);
  std::vector<std::size_t> progress;
  in_parallel(
      times.size(), [&] { return [&](std::size_t i) { ++times[i]; }; },
      [&](std::size_t done) { progress.push_back(done); });
  EXPECT_EQ(times, std::vector<int>(100, 1));
  ASSERT_EQ(progress.size(), 100U);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(progress[i], i + 1);
}

TEST(Parallel, ThrowsOnWhatWorkThrows) {
  const auto fail_at = [](std::size_t i) {
    if (i == 3) throw std::runtime_error("three");
  };
  EXPECT_THROW(in_parallel(
                   10, [&] { return fail_at; }, [](std::size_t) {}),
               std::runtime_error);
}

}  // namespace
}  // namespace scree
