#include "scree/motion/levelling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "motion/simple_drive.hpp"

namespace scree {
namespace {

constexpr double kStep = 0.1;  // seconds

/// A drive whose map grows in the IMU's level frame, which leans.
class LevellingTest : public testing::Test {
protected:
  /// What the sensors say instead of the truth.
  using Fault = std::function<void(double seconds, ImuSample& sample)>;

  void go(test::SimpleDrive drive, double until, const Fault& fault = {}) {
    drive.lean = lean_;
    levelling_ = Levelling(drive.imu_translation);
    DeadReckoning reckoning(drive.imu_mount);
    const auto sensors = std::make_unique<SyncBuffer>();
    SweepTrajectory trajectory;
    pose_ = {};
    farthest_jump_ = 0;
    for (int i = 0; i * kStep < until; ++i) {
      for (int k = 0; k < 10; ++k) {
        const double t = kStep * i + 0.01 * k;
        ImuSample sample = drive.imu(t);
        sample.acceleration += drive.imu_mount.conjugate() * bias_;
        if (fault) fault(t, sample);
        sensors->put(sample);
        if (has_wheel_) sensors->put(drive.wheel(t));
      }
      sensors->gather();
      const Eigen::Vector3d before = levelling_.to_odom() * pose_.translation;
      const MotionStep step =
          reckoning.advance(*sensors, test::nanoseconds(kStep * i),
                            test::nanoseconds(kStep * (i + 1) - 0.01), trajectory);
      pose_ = {pose_.translation + step.displacement, step.attitude};
      levelling_.advance(*sensors, step, pose_);
      const double way = (levelling_.to_odom() * pose_.translation - before).norm();
      farthest_jump_ = std::max(farthest_jump_, std::abs(way - step.displacement.norm()));
    }
  }
  /// The lean of the map's vertical in `odom`, as the truth has it.
  double lean_left() const {
    return (levelling_.to_odom().rotation * lean_ * Eigen::Vector3d::UnitZ()).head<2>().norm();
  }
  double lean_found() const { return logarithm(levelling_.to_odom().rotation).norm(); }

  Eigen::Quaterniond lean_ = exponential({0.008, -0.006, 0});
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();  // m/s^2, axes of `base`
  bool has_wheel_ = true;
  Levelling levelling_{Eigen::Vector3d::Zero()};
  Pose pose_;
  double farthest_jump_ = 0;
};

/// Straight on, faster and slower, the IMU high up and turned.
test::SimpleDrive unsteady() {
  test::SimpleDrive drive;
  drive.distance = [](double t) { return t - 0.5 * std::sin(t); };
  drive.base = [distance = drive.distance](double t) {
    return Pose{{distance(t), 0, 0}, from_roll_pitch_yaw(0.05 * std::sin(3 * t), 0, 0)};
  };
  drive.imu_mount = from_roll_pitch_yaw(0.1, 0.2, 2);
  drive.imu_translation = {0.3, -0.2, 0.6};
  return drive;
}

// Seen from above the drive goes round: the bias goes round with it, the lean does not.
TEST_F(LevellingTest, TellsTheLeanFromTheBiasInCurves) {
  bias_ = {0.04, -0.03, 0.05};
  test::SimpleDrive drive = test::helix(1, 0.5, 0.1, 0.05);
  drive.imu_mount = from_roll_pitch_yaw(0.1, 0.2, 2);
  drive.imu_translation = {0.3, -0.2, 0.6};
  go(drive, 26);
  EXPECT_LT(lean_left(), 0.0015);
}

// Where nothing tells them apart, each gets what its variance is of the sum: 79 % and 21 %.
TEST_F(LevellingTest, SharesWhatItCannotTellApart) {
  const double lean = std::pow(9.81 * 0.006, 2), bias = std::pow(0.03, 2);
  const double share = lean / (lean + bias);
  for (const auto& drive : {test::helix(0, 0, 0), unsteady()}) {
    go(drive, 40);
    EXPECT_NEAR(lean_found() / 0.01, share, 0.04);
    EXPECT_NEAR(lean_left() / 0.01, 1 - share, 0.04);
  }
}

TEST_F(LevellingTest, TurnsTheMapAboutTheRobot) {
  test::SimpleDrive drive = test::helix(1, 0.5, 0);
  go(drive, 20);
  EXPECT_GT(lean_found(), 0.005);
  EXPECT_LT(farthest_jump_, 1e-9);
}

TEST_F(LevellingTest, LeavesTheMapAsItIsWhereASensorIsMissing) {
  const test::SimpleDrive drive = test::helix(1, 0.5, 0);
  go(drive, 5, [](double, ImuSample& sample) { sample.has_acceleration = false; });
  EXPECT_EQ(lean_found(), 0) << "no acceleration";
  go(drive, 5, [](double, ImuSample& sample) {
    sample.acceleration.y() = std::numeric_limits<double>::quiet_NaN();
  });
  EXPECT_EQ(lean_found(), 0) << "no number";
  go(drive, 5, [](double, ImuSample& sample) { sample.has_orientation = sample.has_rate = false; });
  EXPECT_EQ(lean_found(), 0) << "no attitude";
  has_wheel_ = false;
  go(drive, 5);
  EXPECT_EQ(lean_found(), 0) << "no wheel";
  has_wheel_ = true;
  go(drive, 5);
  EXPECT_GT(lean_found(), 0.003) << "all there";
}

TEST_F(LevellingTest, RefusesAShock) {
  const test::SimpleDrive drive = test::helix(1, 0.5, 0);
  go(drive, 20);
  const double undisturbed = lean_left();
  const auto shock = [](double from, double to) {
    return [=](double t, ImuSample& sample) {
      if (t > from && t < to) sample.acceleration.x() += 30;
    };
  };
  go(drive, 20, shock(5.3, 5.4));
  EXPECT_NEAR(lean_left(), undisturbed, 0.0005);
  go(drive, 20, shock(0, 30));
  EXPECT_EQ(lean_found(), 0);
}

TEST_F(LevellingTest, GoesOnAfterSilence) {
  const test::SimpleDrive drive = test::helix(1, 0.5, 0);
  go(drive, 20, [](double t, ImuSample& sample) {
    if (t > 3 && t < 6) sample.has_orientation = sample.has_rate = false;
  });
  EXPECT_LT(lean_left(), 0.0015);
}

}  // namespace
}  // namespace scree
