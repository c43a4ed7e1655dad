#include "app/turn_watch.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

TEST(TurnWatch, NamesAThreadUntilAllHaveGoneRound) {
  Turns quick, slow;
  TurnWatch watch;
  watch.add("quick", quick);
  watch.add("slow", slow);
  EXPECT_EQ(watch.missing(), "quick");
  quick.note();
  EXPECT_EQ(watch.missing(), "slow");
  EXPECT_EQ(watch.missing(), "slow");
  slow.note();
  EXPECT_EQ(watch.missing(), "");
  slow.note();
  EXPECT_EQ(watch.missing(), "quick") << "since all had";
  quick.note();
  EXPECT_EQ(watch.missing(), "");
}

}  // namespace
}  // namespace scree
