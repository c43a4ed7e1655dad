#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "clock_scenario.hpp"

namespace scree {
namespace {

using namespace clock_scenario;

/// Ten minutes of a device on its way to the host, and how far off its times may be once ten
/// seconds have gone by: root mean square and the largest.
struct Case {
  const char* name;
  Way way;
  std::int64_t sample_ns;
  double rms_us, worst_us;

  friend std::ostream& operator<<(std::ostream& out, const Case& of) { return out << of.name; }
};

class DeviceClockAccuracy : public testing::TestWithParam<Case> {};

TEST_P(DeviceClockAccuracy, OverTenMinutesWhateverTheSkew) {
  for (const double ppm : {-100.0, -20.0, 0.0, 3.0, 20.0, 100.0}) {
    Scenario device;
    device.ppm = ppm;
    device.sample_ns = GetParam().sample_ns;
    device.way = GetParam().way;
    double squares = 0, samples = 0, beyond = 0;
    std::int64_t worst = 0, before = 0;
    while (device.now() < kEpoch + 600 * kSecond) {
      device.sample();
      ASSERT_GE(device.host(), before) << "times ran backwards";
      before = device.host();
      if (device.now() < kEpoch + 10 * kSecond) continue;
      const auto error = static_cast<double>(device.error());
      squares += error * error;
      samples += 1;
      beyond += std::abs(device.error()) > device.clock.accuracy_ns() ? 1 : 0;
      worst = std::max(worst, std::abs(device.error()));
    }
    SCOPED_TRACE(testing::Message() << ppm << " ppm");
    EXPECT_LT(std::sqrt(squares / samples) * 1e-3, GetParam().rms_us);
    EXPECT_LT(static_cast<double>(worst) * 1e-3, GetParam().worst_us);
    EXPECT_LT(beyond / samples, 0.05) << "the error is not within what accuracy_ns() says";
    EXPECT_NEAR(static_cast<double>(device.clock.skew_ppb()), -ppm * 1e3, 5e3);
    EXPECT_EQ(device.jumps(), 0U);
    EXPECT_EQ(device.clock.state(), ClockState::estimated);
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, DeviceClockAccuracy,
                         testing::Values(Case{"LidarOnANetwork", network, 1'327'104, 1, 10},
                                         Case{"LidarBusySpells", busy_spells, 1'327'104, 5, 60},
                                         Case{"ImuRarelyPrompt", rarely_prompt, 10'000'000, 15,
                                              150},
                                         Case{"ImuBusyHost100Hz", busy_host, 10'000'000, 8, 60},
                                         Case{"ImuBusyHost400Hz", busy_host, 2'500'000, 4, 40},
                                         Case{"ImuUsb100Hz", UsbAdapter(), 10'000'000, 25, 150},
                                         Case{"ImuUsb1000Hz", UsbAdapter(), 1'000'000, 4, 80}),
                         [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace scree
