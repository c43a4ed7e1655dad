#include "scree/motion/slip_detector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "motion/simple_drive.hpp"
#include "scree/config/settings.hpp"

namespace scree {
namespace {

constexpr double kInterval = 0.1;  // seconds

/// What the wheel rolls too far, by the time in seconds, metres.
using Slip = std::function<double(double)>;

Slip between(double begin, double end, double speed) {
  return [=](double t) { return speed * std::clamp(t - begin, 0.0, end - begin); };
}

/// Starts, drives at two speeds and stops, rolling and pitching as on rough ground.
test::SimpleDrive rough_drive() {
  test::SimpleDrive drive;
  drive.distance = [](double t) { return 0.8 * t - 0.4 * std::sin(2 * t); };  // 0 to 1.6 m/s
  drive.base = [distance = drive.distance](double t) {
    return Pose{{distance(t), 0, 0},
                from_roll_pitch_yaw(0.1 * std::sin(5 * t), 0.08 * std::sin(7 * t), 0.0)};
  };
  drive.imu_mount = from_roll_pitch_yaw(0.1, -0.2, 1.5);
  drive.imu_translation = {0.2, -0.1, 0.4};
  return drive;
}

class SlipDetectorTest : public testing::Test {
protected:
  /// Drives for 10 s; the steps during which the wheel slips, by their number.
  std::vector<int> slips(const Slip& slip, const std::function<void(ImuSample&)>& fault = {}) {
    SlipDetector detector(drive_.imu_mount, drive_.imu_translation, EncoderSettings().max_speed);
    const auto sensors = std::make_unique<SyncBuffer>();
    std::vector<int> steps;
    farthest_off_ = 0;
    for (int i = 0; i < 100; ++i) {
      for (int k = 0; k < 10; ++k) {
        const double t = kInterval * i + 0.01 * k;
        ImuSample imu = drive_.imu(t);
        if (fault) fault(imu);
        sensors->put(imu);
        EncoderSample wheel = drive_.wheel(t);
        wheel.distance += slip(t);
        if (t < silent_from_ || t >= silent_until_) sensors->put(wheel);
      }
      sensors->gather();
      detector.advance(*sensors, test::nanoseconds(kInterval * i - 0.01),
                       test::nanoseconds(kInterval * (i + 1) - 0.01), detector.speed());
      const double now = kInterval * (i + 1) - 0.01;
      const double speed = (drive_.distance(now + 1e-3) - drive_.distance(now - 1e-3)) / 2e-3;
      if (i > 0) farthest_off_ = std::max(farthest_off_, std::abs(detector.speed() - speed));
      if (detector.slips()) steps.push_back(i);
    }
    return steps;
  }

  test::SimpleDrive drive_ = rough_drive();
  double silent_from_ = 99, silent_until_ = 99;
  double farthest_off_ = 0;  // of the speed, m/s
};

TEST_F(SlipDetectorTest, ARobotThatChangesItsSpeedOnRoughGroundDoesNotSlip) {
  EXPECT_TRUE(slips(between(0, 0, 0)).empty());
  EXPECT_LT(farthest_off_, 0.1);
}

TEST_F(SlipDetectorTest, AWheelThatSpinsIsNotBelievedUntilItAgrees) {
  for (const double speed : {1.0, -1.0, 2.5}) {
    const auto steps = slips(between(3, 4, speed));
    ASSERT_FALSE(steps.empty()) << speed;
    EXPECT_EQ(steps.front(), 30);
    EXPECT_GE(steps.back(), 39);
    EXPECT_LE(steps.back(), 43);
    EXPECT_EQ(steps.size(), static_cast<std::size_t>(steps.back() - steps.front() + 1));
    EXPECT_LT(farthest_off_, 0.15) << "the speed is the robot's";
  }
}

TEST_F(SlipDetectorTest, ACounterThatStandsIsNotBelieved) {
  // From 1.5 to 3 s.
  const auto steps = slips([&](double t) {
    return drive_.distance(std::min(t, 1.5)) - drive_.distance(std::min(t, 3.0));
  });
  ASSERT_FALSE(steps.empty());
  EXPECT_LT(farthest_off_, 0.15);
}

TEST_F(SlipDetectorTest, AWheelThatInsistsIsBelievedInTheEnd) {
  const auto steps = slips(between(2, 99, 1.0));
  ASSERT_FALSE(steps.empty());
  EXPECT_LT(steps.back(), 65) << "the IMU alone does not know for so long";
}

TEST_F(SlipDetectorTest, WithoutAccelerationTheWheelIsBelieved) {
  EXPECT_TRUE(
      slips(between(3, 4, 1), [](ImuSample& imu) { imu.has_acceleration = false; }).empty());
}

TEST_F(SlipDetectorTest, KnowsTheSpeedWhileTheWheelIsSilent) {
  silent_from_ = 2;
  silent_until_ = 5;
  EXPECT_TRUE(slips(between(0, 0, 0)).empty());
  EXPECT_LT(farthest_off_, 0.1);
}

TEST_F(SlipDetectorTest, KnowsNoSpeedBeyondTheRobots) {
  silent_from_ = 2;
  slips(between(0, 0, 0), [](ImuSample& imu) { imu.acceleration *= 30; });
  EXPECT_LT(farthest_off_, EncoderSettings().max_speed + 2);
}

}  // namespace
}  // namespace scree
