// What holds of the clocks whatever the delays are.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "scree/clock/device_clock.hpp"
#include "scree/clock/host_clock.hpp"
#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

constexpr std::int64_t kHour = 3600 * kSecond;

TEST(ClockLaws, ADevicesTimesRunOnWhateverTheDelaysAre) {
  EXPECT_TRUE(rc::check([] {
    DeviceClock clock(kHour);
    std::int64_t device_ns = *rc::gen::inRange<std::int64_t>(0, kHour);
    std::int64_t sent_ns = 1'598'612'523 * kSecond, last_ns = 0;
    for (int i = 0; i < 200; ++i) {
      const auto step = *rc::gen::inRange<std::int64_t>(kMillisecond, 20 * kMillisecond);
      const auto delay = *rc::gen::inRange<std::int64_t>(0, 40 * kMillisecond);
      device_ns = (device_ns + step) % kHour;
      sent_ns += step;
      const bool started_over = clock.update(device_ns, sent_ns + delay);
      const std::int64_t host_ns = clock.to_host(device_ns);
      RC_ASSERT(started_over || host_ns > last_ns);
      RC_ASSERT(host_ns >= sent_ns - kMillisecond);
      last_ns = host_ns;
    }
  }));
}

TEST(ClockLaws, SettingTheHostsClockMovesNoStamp) {
  EXPECT_TRUE(rc::check([] {
    HostClock clock;
    std::int64_t monotonic_ns = 5000 * kSecond, difference_ns = 1'598'612'523 * kSecond;
    for (int i = 0; i < 50; ++i) {
      const std::int64_t stamp_ns = monotonic_ns + difference_ns, at_ns = monotonic_ns;
      monotonic_ns += *rc::gen::inRange<std::int64_t>(0, 50 * kMillisecond);
      const bool is_set = *rc::gen::inRange(0, 10) == 0;
      const std::int64_t before_ns = monotonic_ns;
      // Twice within the time that stamps may wait, what was before is not known.
      if (is_set) monotonic_ns += 3 * kSecond;
      RC_ASSERT(clock.to_monotonic(stamp_ns, {before_ns, before_ns + difference_ns, 0}) == at_ns);
      if (is_set) difference_ns += *rc::gen::inRange<std::int64_t>(-kHour, 24 * kHour);
      RC_ASSERT(clock.to_monotonic(monotonic_ns + difference_ns,
                                   {monotonic_ns, monotonic_ns + difference_ns, 0}) ==
                monotonic_ns);
    }
  }));
}

}  // namespace
}  // namespace scree
