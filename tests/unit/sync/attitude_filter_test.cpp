#include "scree/sync/attitude_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "scree/core/nanoseconds.hpp"
#include "scree/core/pose.hpp"
#include "scree/core/rotation.hpp"

namespace scree {
namespace {

constexpr std::int64_t kSampleNs = 10 * kMillisecond;
const Eigen::Vector3d kUp(0, 0, 9.81);

class AttitudeFilterTest : public testing::Test {
protected:
  /// What an IMU measures for so long that turns at `rate` (sensor's axes) while the robot speeds
  /// up by `push` (m/s^2) along its x axis, which is the IMU's.
  void drive(double seconds, const Eigen::Vector3d& rate, double push = 0) {
    for (double t = 0; t < seconds - 1e-9; t += 0.01) {
      ImuSample sample;
      sample.t_ns = now_ns_ += kSampleNs;
      truth_ = truth_ * exponential(rate * 0.01);
      sample.has_rate = sample.has_acceleration = true;
      sample.rate = rate + bias_;
      speeds_.push_back(speeds_.back() + push * 0.01);
      sample.acceleration = truth_.conjugate() * kUp + Eigen::Vector3d(push, 0, 0) +
                            rate.cross(Eigen::Vector3d(speeds_.back(), 0, 0));
      has_attitude_ = complete(sample);
      found_ = sample;
    }
  }
  bool complete(ImuSample& sample) {
    return filter_.complete(sample, [this](std::int64_t t_ns) -> std::optional<double> {
      if (!has_wheel_) return std::nullopt;
      return speeds_.at(static_cast<std::size_t>((t_ns - kSecond) / kSampleNs));
    });
  }
  /// Angle between the vertical and what the filter takes for it, rad.
  double tilt() const {
    const Eigen::Vector3d up = found_.orientation.conjugate() * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d true_up = truth_.conjugate() * Eigen::Vector3d::UnitZ();
    return std::acos(std::min(1.0, up.dot(true_up)));
  }

  AttitudeFilter filter_{Eigen::Quaterniond::Identity()};
  std::vector<double> speeds_ = {0};  // of the wheel, with every sample
  bool has_wheel_ = true;
  Eigen::Quaterniond truth_ = from_roll_pitch_yaw(0.3, -0.2, 1.1);
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  std::int64_t now_ns_ = kSecond;
  bool has_attitude_ = false;
  ImuSample found_;
};

TEST_F(AttitudeFilterTest, KnowsRollAndPitchOfARobotThatStands) {
  drive(0.5, {0, 0, 0});
  EXPECT_FALSE(has_attitude_);
  drive(2, {0, 0, 0});
  EXPECT_TRUE(has_attitude_);
  EXPECT_LT(tilt(), 1e-3);
}

TEST_F(AttitudeFilterTest, FollowsTurnsAboutAllAxesByTheRates) {
  drive(3, {0, 0, 0});
  const Eigen::Quaterniond yawed = truth_ * found_.orientation.conjugate();
  drive(1, {0.6, 0, 0.3});
  drive(1, {-0.2, 0.5, -0.4});
  EXPECT_LT(tilt(), 5e-3);
  EXPECT_LT((truth_ * found_.orientation.conjugate()).angularDistance(yawed), 5e-3);
}

TEST_F(AttitudeFilterTest, LearnsTheBiasOfRollAndPitchRates) {
  bias_ = {0.003, -0.002, 0};
  truth_.setIdentity();
  drive(60, {0, 0, 0});
  EXPECT_LT(tilt(), 1e-3);
  EXPECT_LT(found_.rate.norm(), 2e-4);
}

TEST_F(AttitudeFilterTest, ARobotThatSpeedsUpTiltsItNot) {
  drive(5, {0, 0, 0});
  drive(2, {0, 0, 0}, 1.5);  // the specific force leans by 0.15 rad
  EXPECT_LT(tilt(), 2e-3);
  drive(10, {0, 0, 0.5});
  EXPECT_LT(tilt(), 5e-3) << "in a curve at 3 m/s";
}

TEST_F(AttitudeFilterTest, WithoutAWheelItTiltsItLittle) {
  has_wheel_ = false;
  drive(30, {0, 0, 0});
  drive(2, {0, 0, 0}, 1.5);
  EXPECT_LT(tilt(), 0.04);
}

TEST_F(AttitudeFilterTest, StaysOutOfTheWayOfAnImuThatSendsOrientations) {
  drive(5, {0, 0, 0});
  ImuSample own;
  own.t_ns = now_ns_ += kSampleNs;
  own.has_orientation = true;
  own.orientation = from_roll_pitch_yaw(0.5, 0.4, 0.3);
  EXPECT_TRUE(complete(own));
  EXPECT_EQ(own.orientation.coeffs(), from_roll_pitch_yaw(0.5, 0.4, 0.3).coeffs());
  drive(0.4, {0, 0, 0});
  EXPECT_FALSE(has_attitude_) << "samples of high rate come between";
}

TEST_F(AttitudeFilterTest, GoesOnFromTheLastOrientationThatWasSent) {
  ImuSample own;
  own.t_ns = now_ns_;
  own.has_orientation = own.has_rate = true;
  own.orientation = truth_;
  EXPECT_TRUE(complete(own));
  drive(0.6, {0.1, 0.2, 0.3});
  EXPECT_TRUE(has_attitude_);
  EXPECT_LT(found_.orientation.angularDistance(truth_), 0.01);
}

TEST_F(AttitudeFilterTest, BeginsAnewAfterSilence) {
  drive(5, {0, 0, 0});
  now_ns_ += kSecond;
  speeds_.resize(speeds_.size() + 100);
  truth_ = from_roll_pitch_yaw(-0.2, 0.1, 0);
  drive(0.5, {0, 0, 0});
  EXPECT_FALSE(has_attitude_);
  drive(2, {0, 0, 0});
  EXPECT_TRUE(has_attitude_);
  EXPECT_LT(tilt(), 1e-3);
}

TEST_F(AttitudeFilterTest, RatesAloneAreNoAttitude) {
  ImuSample sample;
  sample.has_rate = true;
  for (int i = 0; i < 300; ++i) {
    sample.t_ns = now_ns_ += kSampleNs;
    EXPECT_FALSE(complete(sample));
  }
}

TEST_F(AttitudeFilterTest, TakesRatesAndAccelerationsThatComeApart) {
  has_wheel_ = false;
  for (int i = 0; i < 600; ++i) {
    ImuSample force;
    force.t_ns = now_ns_ += kSampleNs / 2;
    force.has_acceleration = true;
    force.acceleration = truth_.conjugate() * kUp;
    EXPECT_FALSE(complete(force));
    ImuSample turn;
    turn.t_ns = now_ns_ += kSampleNs / 2;
    turn.has_rate = true;
    has_attitude_ = complete(turn);
    found_ = turn;
  }
  EXPECT_TRUE(has_attitude_);
  EXPECT_LT(tilt(), 1e-3);
}

}  // namespace
}  // namespace scree
