#include "scree/drivers/velodyne/one_sender.hpp"

#include <gtest/gtest.h>

namespace scree::velodyne {
namespace {

TEST(OneSender, TakesTheFirstAndCountsTheOthers) {
  OneSender senders;
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(senders.takes(7, i * kMillisecond));
    EXPECT_FALSE(senders.takes(8, i * kMillisecond));
  }
  EXPECT_EQ(senders.taken(), 7U);
  EXPECT_EQ(senders.other(), 8U);
  EXPECT_EQ(senders.left_out(), 100U);
}

TEST(OneSender, AnotherOneTakesOverFromASilentOne) {
  OneSender senders;
  EXPECT_TRUE(senders.takes(7, 0));
  EXPECT_FALSE(senders.takes(8, kSecond));
  EXPECT_TRUE(senders.takes(8, kSecond + 1));
  EXPECT_FALSE(senders.takes(7, kSecond + 2));
}

TEST(OneSender, WhereNoneIsKnownAllAreTaken) {
  OneSender senders;
  EXPECT_TRUE(senders.takes(0, 0));
  EXPECT_TRUE(senders.takes(7, 1));
  EXPECT_TRUE(senders.takes(0, 2));
  EXPECT_EQ(senders.other(), 0U);
}

}  // namespace
}  // namespace scree::velodyne
