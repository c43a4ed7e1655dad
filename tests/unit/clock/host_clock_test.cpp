#include "scree/clock/host_clock.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

constexpr std::int64_t kEpoch = 1'598'612'523 * kSecond;

/// A host whose wall clock somebody sets.
struct Host {
  std::int64_t monotonic_ns = 5000 * kSecond, set_by_ns = 0;

  std::int64_t real_ns() const { return kEpoch + monotonic_ns + set_by_ns; }
  ClockReading now() const { return {monotonic_ns, real_ns(), 0}; }
};

TEST(HostClock, BringsStampsToTheMonotonicClockAndBack) {
  Host host;
  HostClock clock;
  const std::int64_t stamp = host.real_ns(), at = host.monotonic_ns;
  host.monotonic_ns += 3 * kMillisecond;
  EXPECT_EQ(clock.to_monotonic(stamp, host.now()), at);
  host.monotonic_ns += 40 * kMillisecond;
  EXPECT_EQ(clock.to_real(at, host.now()), stamp);
  EXPECT_EQ(clock.steps(), 0U);
}

TEST(HostClock, ASetWallClockDisturbsNoStamp) {
  for (const std::int64_t step : {-40 * 365 * 86'400 * kSecond, -3600 * kSecond, -kSecond / 3,
                                  -20 * kMillisecond, 20 * kMillisecond, kSecond, 3600 * kSecond}) {
    Host host;
    HostClock clock;
    for (int i = 0; i < 100; ++i) {
      // Four datagrams arrive, then they are read; the clock is set between the second and third.
      std::int64_t stamp[4], at[4];
      for (int k = 0; k < 4; ++k, host.monotonic_ns += kMillisecond) {
        if (i == 50 && k == 2) host.set_by_ns += step;
        stamp[k] = host.real_ns();
        at[k] = host.monotonic_ns;
      }
      for (int k = 0; k < 4; ++k) {
        EXPECT_EQ(clock.to_monotonic(stamp[k], host.now()), at[k]) << step << " " << i;
      }
      EXPECT_EQ(clock.to_real(at[3], host.now()), host.real_ns() - kMillisecond);
      host.monotonic_ns += 60 * kMillisecond;
    }
    EXPECT_EQ(clock.steps(), 1U);
  }
}

TEST(HostClock, InARecordingTimeRunsOnWhenTheWallClockIsSet) {
  for (const std::int64_t step : {-3600 * kSecond, -kSecond / 3, 3600 * kSecond}) {
    Host host;
    HostClock clock;
    const std::int64_t began = host.real_ns();
    EXPECT_EQ(clock.to_first_real(began - 10 * kSecond, host.now()), began - 10 * kSecond)
        << "it waited long, and nobody has set the clock";
    for (int i = 0; i < 100; ++i, host.monotonic_ns += 60 * kMillisecond) {
      if (i == 50) host.set_by_ns = step;
      EXPECT_EQ(clock.to_first_real(host.real_ns(), host.now()), began + i * 60 * kMillisecond);
    }
  }
}

TEST(HostClock, IsNotMovedByTheJitterOfReadings) {
  Host host;
  HostClock clock;
  std::mt19937 random(1);
  const std::int64_t first = clock.to_real(host.monotonic_ns, host.now()) - host.monotonic_ns;
  for (int i = 0; i < 1000; ++i, host.monotonic_ns += kMillisecond) {
    ClockReading now = host.now();
    now.width_ns = i % 100 == 0 ? 5 * kMillisecond : 50'000;  // the thread was interrupted
    now.real_ns += static_cast<std::int64_t>(random()) % now.width_ns;
    EXPECT_EQ(clock.to_real(host.monotonic_ns, now) - host.monotonic_ns, first);
  }
  EXPECT_EQ(clock.steps(), 0U);
}

TEST(HostClock, AStampThatMakesNoSenseIsOfNow) {
  Host host;
  HostClock clock;
  for (const std::int64_t stamp :
       {std::int64_t{0}, host.real_ns() - 7200 * kSecond, host.real_ns() + kSecond}) {
    EXPECT_EQ(clock.to_monotonic(stamp, host.now()), host.monotonic_ns);
  }
}

TEST(HostClock, AStampThatWaitedWhileTheProcessWasPausedIsAsOldAsItIs) {
  Host host;
  HostClock clock;
  for (const std::int64_t age : {4 * kSecond, 600 * kSecond}) {
    EXPECT_EQ(clock.to_monotonic(host.real_ns() - age, host.now()), host.monotonic_ns - age);
  }
}

TEST(HostClock, OldDifferencesAreForgotten) {
  Host host;
  HostClock clock;
  clock.to_real(0, host.now());
  host.set_by_ns = -kSecond;
  clock.to_real(0, host.now());
  host.monotonic_ns += 3 * kSecond;
  // Were the clock still set as before, this stamp would be of now.
  EXPECT_EQ(clock.to_monotonic(host.real_ns() + kSecond - 10, host.now()), host.monotonic_ns);
  EXPECT_EQ(clock.to_monotonic(host.real_ns() - 10, host.now()), host.monotonic_ns - 10);
}

}  // namespace
}  // namespace scree
