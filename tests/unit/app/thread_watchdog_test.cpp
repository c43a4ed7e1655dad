#include "app/thread_watchdog.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

TEST(ThreadWatchdog, NamesAThreadUntilAllHaveLooped) {
  LoopCounter quick, slow;
  ThreadWatchdog watchdog;
  watchdog.add("quick", quick);
  watchdog.add("slow", slow);
  EXPECT_EQ(watchdog.stalled(), "quick");
  quick.increment();
  EXPECT_EQ(watchdog.stalled(), "slow");
  EXPECT_EQ(watchdog.stalled(), "slow");
  slow.increment();
  EXPECT_EQ(watchdog.stalled(), "");
  slow.increment();
  EXPECT_EQ(watchdog.stalled(), "quick") << "since all had";
  quick.increment();
  EXPECT_EQ(watchdog.stalled(), "");
}

}  // namespace
}  // namespace scree
