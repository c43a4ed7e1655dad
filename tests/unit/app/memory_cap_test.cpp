#include "scree/app/memory_cap.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace scree {
namespace {

rlim_t limit() {
  rlimit now{};
  getrlimit(RLIMIT_AS, &now);
  return now.rlim_cur;
}

TEST(MemoryCap, LimitsWhatIsTakenAndLiftsTheLimitAgain) {
  const rlim_t before = limit();
  {
    const MemoryCap cap;
    EXPECT_LT(limit(), before);
    EXPECT_GE(limit(), memory_taken());
    EXPECT_THAT(cap.sentence(), testing::HasSubstr("[memory]"));
  }
  EXPECT_EQ(limit(), before);
}

TEST(MemoryCap, SeesALimitOfTheProcess) {
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  const std::uint64_t left = 50'000'000;
  const rlimit low{memory_taken() + left, before.rlim_max};
  setrlimit(RLIMIT_AS, &low);
  EXPECT_LE(memory_left(), left);
  setrlimit(RLIMIT_AS, &before);
}

}  // namespace
}  // namespace scree
