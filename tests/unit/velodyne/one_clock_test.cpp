#include "scree/drivers/velodyne/one_clock.hpp"

#include <gtest/gtest.h>

namespace scree::velodyne {
namespace {

constexpr std::int64_t kArrival = 1'598'612'523 * kSecond;

TEST(OneClock, TakesTheFirstOfTwoThatRunBesideEachOther) {
  for (const std::int64_t ahead : {80 * kMillisecond, 700 * kSecond, kHourNs / 2}) {
    OneClock clock;
    int other = 0;
    for (std::int64_t t = 0; t < 2 * kSecond; t += kPacketNs) {
      EXPECT_TRUE(clock.takes(t, kArrival + t));
      const std::int64_t later = t + kPacketNs / 3;
      other += clock.takes((later + ahead) % kHourNs, kArrival + later) ? 1 : 0;
    }
    EXPECT_EQ(other, 1) << "the first one could be a sensor that has started anew";
  }
}

TEST(OneClock, ASensorThatStartsAnewIsTaken) {
  OneClock clock;
  for (int start = 0; start < 3; ++start) {
    for (std::int64_t t = 0; t < kSecond; t += kPacketNs) {
      EXPECT_TRUE(clock.takes(t + start * 17 * kSecond, kArrival + start * kSecond + t));
    }
  }
}

TEST(OneClock, TheSecondOneTakesOverWhenTheFirstIsSilent) {
  OneClock clock;
  std::int64_t t = 0;
  for (; t < kSecond; t += kPacketNs) {
    EXPECT_TRUE(clock.takes(t, kArrival + t));
    clock.takes(t + 100 * kSecond, kArrival + t);
  }
  const std::int64_t last = t;
  for (; t < last + 3 * kSecond; t += kPacketNs) {
    const bool is_over = t - (last - kPacketNs) >= kSecond;
    EXPECT_EQ(clock.takes(t + 100 * kSecond, kArrival + t), is_over);
  }
}

TEST(OneClock, TheFullHourAndABusyHostAreNoOtherClock) {
  OneClock clock;
  const std::int64_t begin = kHourNs - kSecond;
  for (std::int64_t t = 0; t < 2 * kSecond; t += kPacketNs) {
    // What comes in the last 80 ms of each 100 is read at their end.
    const std::int64_t read = t % (100 * kMillisecond) < 20 * kMillisecond
                                  ? t
                                  : (t / (100 * kMillisecond) + 1) * 100 * kMillisecond - 1;
    EXPECT_TRUE(clock.takes((begin + t) % kHourNs, kArrival + read));
  }
}

}  // namespace
}  // namespace scree::velodyne
