#include "scree/sync/heading_jump_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "scree/core/nanoseconds.hpp"
#include "scree/core/pose.hpp"
#include "scree/core/rotation.hpp"

namespace scree {
namespace {

constexpr double kSeconds = 10;

/// An IMU, mounted on its side, of a robot that winds its way over rough ground. Its gyroscope is
/// off by 0.5 deg/s and 1 percent and has noise.
class HeadingJumpFilterTest : public testing::Test {
protected:
  static Eigen::Quaterniond truth(double t) {
    const Eigen::Quaterniond robot = from_roll_pitch_yaw(
        0.1 * std::sin(4 * t), 0.08 * std::sin(5 * t + 1), 0.7 * std::sin(1.5 * t));
    return robot * from_roll_pitch_yaw(1.5, 0.1, 0.4);
  }

  /// Yaw that the watch left in the end, rad; the largest on the way in `most_`.
  /// @param fault what the device makes of the sample at t
  double left(const std::function<void(double t, ImuSample&)>& fault) {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, 0.01);
    double off = 0;
    for (int i = 0; i <= static_cast<int>(kSeconds / interval_); ++i) {
      const double t = interval_ * i;
      if (t > silent_from_ && t < silent_until_) continue;
      ImuSample sample;
      sample.t_ns = static_cast<std::int64_t>(t * 1e9);
      sample.has_orientation = sample.has_rate = true;
      sample.orientation = truth(t);
      constexpr double kStep = 1e-4;
      sample.rate = 1.01 * logarithm(truth(t - kStep).conjugate() * truth(t + kStep)) / (2 * kStep);
      sample.rate += Eigen::Vector3d(noise(random), noise(random) + 0.009, noise(random));
      fault(t, sample);
      filter_.correct(sample);
      off = logarithm(sample.orientation * truth(t).conjugate()).z();
      most_ = std::max(most_, std::abs(off));
    }
    return off;
  }
  static void turn(ImuSample& sample, double yaw) {
    sample.orientation = exponential({0, 0, yaw}) * sample.orientation;
  }

  HeadingJumpFilter filter_;
  double interval_ = 0.01, most_ = 0;
  double silent_from_ = 99, silent_until_ = 99;
};

TEST_F(HeadingJumpFilterTest, WhatTheRateKnowsOfIsBelieved) {
  for (const double interval : {0.01, 0.0025, 0.02}) {
    interval_ = interval;
    filter_ = HeadingJumpFilter();
    EXPECT_EQ(left([](double, ImuSample&) {}), 0);
    EXPECT_LT(most_, 1e-9);
    EXPECT_EQ(filter_.corrections(), 0U) << interval;
  }
}

TEST_F(HeadingJumpFilterTest, AResetOfTheHeadingIsTakenOut) {
  for (const double degrees : {4.0, -5.0, 20.0, 179.0}) {
    filter_ = HeadingJumpFilter();
    const double off = left([&](double t, ImuSample& sample) {
      if (t >= 4) turn(sample, radians(degrees));
    });
    EXPECT_LT(std::abs(off), radians(1)) << degrees;
    EXPECT_EQ(filter_.corrections(), 1U) << degrees;
  }
}

TEST_F(HeadingJumpFilterTest, OfASlowCorrectionLittleIsLeft) {
  const double off = left([](double t, ImuSample& sample) {
    turn(sample, radians(6 * std::min(std::max(t - 4, 0.0), 3.0)));
  });
  EXPECT_LT(std::abs(off), radians(6)) << "of 18 degrees";
  EXPECT_GT(filter_.corrections(), 0U);
}

TEST_F(HeadingJumpFilterTest, AYawThatTremblesAndVibrationAreNoCorrections) {
  std::mt19937 random(6);
  std::normal_distribution<double> tremble(0, radians(0.2)), vibration(0, 0.5);
  left([&](double, ImuSample& sample) {
    turn(sample, tremble(random));
    sample.rate += Eigen::Vector3d(vibration(random), vibration(random), vibration(random));
  });
  EXPECT_EQ(filter_.corrections(), 0U);
}

TEST_F(HeadingJumpFilterTest, AGarbledRateTurnsNothing) {
  left([](double t, ImuSample& sample) {
    if (t > 4.995 && t < 5.005) sample.rate = {60, -60, 60};
  });
  EXPECT_EQ(filter_.corrections(), 0U);
}

TEST_F(HeadingJumpFilterTest, WithoutRateAndAfterAPauseTheYawIsBelieved) {
  const auto reset = [](double t, ImuSample& sample) {
    if (t >= 4) turn(sample, 0.5);
  };
  EXPECT_NEAR(left([&](double t, ImuSample& sample) {
                reset(t, sample);
                sample.has_rate = false;
              }),
              0.5, 1e-9);
  silent_from_ = 3.5;
  silent_until_ = 4.5;
  filter_ = HeadingJumpFilter();
  EXPECT_NEAR(left(reset), 0.5, 1e-9);
  EXPECT_EQ(filter_.corrections(), 0U);
}

TEST_F(HeadingJumpFilterTest, ATiltIsNotItsBusiness) {
  const double off = left([](double t, ImuSample& sample) {
    if (t >= 4) sample.orientation = exponential({0.2, 0, 0}) * sample.orientation;
  });
  EXPECT_LT(std::abs(off), 0.02);
  EXPECT_EQ(filter_.corrections(), 0U);
}

}  // namespace
}  // namespace scree
