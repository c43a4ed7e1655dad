#include "scree/sync/device_clock.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

namespace scree {
namespace {

constexpr std::int64_t kHour = 3'600'000'000'000, kSecond = 1'000'000'000, kMillisecond = 1'000'000;
constexpr std::int64_t kPacket = 1'327'104;
constexpr std::int64_t kEpoch = 1'598'612'523 * kSecond;

/// A sensor that runs `ppm` faster than the host, and a network with a delay of its own.
class Simulation {
public:
  DeviceClock clock{kHour};
  std::int64_t device_at_start = 100 * kSecond;
  double ppm = 0;
  std::int64_t least_delay = 100'000;

  std::int64_t device(std::int64_t true_ns) const {
    const auto gained =
        static_cast<std::int64_t>(static_cast<double>(true_ns - kEpoch) * ppm * 1e-6);
    return (device_at_start + true_ns - kEpoch + gained) % kHour;
  }
  std::int64_t delay() {
    // Mostly next to none, now and then a host that is busy for milliseconds.
    std::exponential_distribution<double> usual(1.0 / 50e3), busy(1.0 / 3e6);
    return least_delay +
           static_cast<std::int64_t>(random_() % 50 == 0 ? busy(random_) : usual(random_));
  }
  bool packet(std::int64_t true_ns) { return clock.update(device(true_ns), true_ns + delay()); }
  std::int64_t error(std::int64_t true_ns) const {
    return clock.to_host(device(true_ns)) - true_ns - least_delay;
  }

private:
  std::mt19937 random_{7};
};

TEST(DeviceClock, FindsTheHostsTimeBehindDelaysAndSkew) {
  for (const double ppm : {-150.0, -20.0, 0.0, 20.0, 150.0}) {
    Simulation simulation;
    simulation.ppm = ppm;
    std::int64_t worst = 0;
    for (std::int64_t t = kEpoch; t < kEpoch + 60 * kSecond; t += kPacket) {
      simulation.packet(t);
      if (t > kEpoch + kSecond / 10) worst = std::max(worst, std::abs(simulation.error(t)));
    }
    EXPECT_LT(worst, 50'000) << ppm;
    EXPECT_EQ(simulation.clock.device_restarts() + simulation.clock.host_steps(), 0U);
  }
}

TEST(DeviceClock, RunsOnAcrossTheFullHour) {
  Simulation simulation;
  simulation.device_at_start = kHour - 5 * kSecond;
  for (std::int64_t t = kEpoch; t < kEpoch + 10 * kSecond; t += kPacket) {
    simulation.packet(t);
    ASSERT_LT(std::abs(simulation.error(t)), 20 * kMillisecond);
  }
  EXPECT_LT(std::abs(simulation.error(kEpoch + 10 * kSecond)), 50'000);
  EXPECT_EQ(simulation.clock.device_restarts() + simulation.clock.host_steps(), 0U);
}

TEST(DeviceClock, FindsTheHourAfterAGapOfAnyLength) {
  for (const std::int64_t gap : {2 * kSecond, kHour / 2, kHour, 3 * kHour + 1700 * kSecond}) {
    Simulation simulation;
    simulation.device_at_start = kHour - 5 * kSecond;
    simulation.ppm = 30;
    for (std::int64_t t = kEpoch; t < kEpoch + 4 * kSecond; t += kPacket) simulation.packet(t);
    const std::int64_t back = kEpoch + 4 * kSecond + gap;
    EXPECT_FALSE(simulation.packet(back)) << gap;
    for (std::int64_t t = back + kPacket; t < back + kSecond; t += kPacket) simulation.packet(t);
    EXPECT_LT(std::abs(simulation.error(back + kSecond)), 50'000) << gap;
    EXPECT_EQ(simulation.clock.device_restarts() + simulation.clock.host_steps(), 0U);
  }
}

TEST(DeviceClock, CountsARestartOfTheDevice) {
  Simulation simulation;
  std::int64_t t = kEpoch;
  for (; t < kEpoch + 2 * kSecond; t += kPacket) simulation.packet(t);
  simulation.device_at_start = kHour - 2 * kSecond - 10 * kSecond;  // near its 0
  t += 8 * kSecond;
  EXPECT_TRUE(simulation.packet(t));
  EXPECT_EQ(simulation.clock.device_restarts(), 1U);
  EXPECT_EQ(simulation.clock.host_steps(), 0U);
  for (; t < kEpoch + 12 * kSecond; t += kPacket) simulation.packet(t);
  EXPECT_LT(std::abs(simulation.error(t)), 50'000);
}

TEST(DeviceClock, CountsStepsOfTheHostsClock) {
  for (const std::int64_t step :
       {-3600 * kSecond, -2 * kSecond, 5 * kSecond, 3600 * kSecond + 77}) {
    DeviceClock clock(kHour);
    std::int64_t device = 0;
    for (int i = 0; i < 1000; ++i, device += kPacket) clock.update(device, kEpoch + device);
    // A whole hour forward cannot be told from a gap of as long, but the times come out right.
    const bool told = clock.update(device, kEpoch + device + step);
    EXPECT_EQ(told, step < 3600 * kSecond) << step;
    EXPECT_EQ(clock.host_steps(), told ? 1U : 0U);
    EXPECT_EQ(clock.device_restarts(), 0U);
    EXPECT_NEAR(static_cast<double>(clock.to_host(device) - kEpoch - device - step), 0, 1e6);
  }
}

TEST(DeviceClock, CountsASmallStepForwardAfterASecond) {
  DeviceClock clock(kHour);
  std::int64_t device = 0;
  for (int i = 0; i < 1000; ++i, device += kPacket) clock.update(device, kEpoch + device);
  for (int i = 0; i < 1000; ++i, device += kPacket) {
    clock.update(device, kEpoch + device + 300 * kMillisecond);
  }
  EXPECT_EQ(clock.host_steps(), 1U);
  EXPECT_NEAR(static_cast<double>(clock.to_host(device) - kEpoch - device - 300 * kMillisecond), 0,
              1e3);
}

TEST(DeviceClock, AHostThatWasBusyIsNoStep) {
  DeviceClock clock(kHour);
  std::int64_t device = 0;
  for (int i = 0; i < 3000; ++i, device += kPacket) {
    const bool busy = i % 600 < 300;  // 0.4 s during which all packets wait
    clock.update(device, kEpoch + device + (busy ? 200 * kMillisecond : 0));
  }
  EXPECT_EQ(clock.host_steps(), 1U) << "the very first packet was late; none after it is a step";
}

}  // namespace
}  // namespace scree
