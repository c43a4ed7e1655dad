#include "scree/motion/dead_reckoning.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "allocation_counter.hpp"
#include "motion/simple_drive.hpp"

namespace scree {
namespace {

using test::nanoseconds;
using test::SimpleDrive;

constexpr double kSweep = 0.1;  // seconds

/// Follows a drive sweep by sweep, as the mapper does.
class Follower {
public:
  explicit Follower(const SimpleDrive& drive) : drive_(drive), reckoning_(drive.imu_mount) {}

  SyncBuffer& sensors() { return *sensors_; }
  DeadReckoning& reckoning() { return reckoning_; }
  const SweepTrajectory& trajectory() const { return trajectory_; }
  /// In the IMU's level frame, from the first sweep's begin on.
  const Eigen::Vector3d& position() const { return position_; }

  MotionStep sweep(double end, double shift = 0) {
    const MotionStep step = reckoning_.advance(*sensors_, nanoseconds(end - kSweep + shift),
                                               nanoseconds(end + shift), trajectory_);
    position_ += step.displacement;
    return step;
  }
  Eigen::Vector3d true_position(double end, double begin = 0) const {
    return exponential({0, 0, drive_.yaw_offset}) *
           (drive_.base(end).translation - drive_.base(begin).translation);
  }

private:
  SimpleDrive drive_;
  std::unique_ptr<SyncBuffer> sensors_ = std::make_unique<SyncBuffer>();
  DeadReckoning reckoning_;
  SweepTrajectory trajectory_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
};

void expect_exact(SimpleDrive drive) {
  drive.imu_mount = from_roll_pitch_yaw(0.1, 3.0, -1.2);
  drive.yaw_offset = 2.5;
  Follower follower(drive);
  drive.put(follower.sensors(), 0, 20.1);
  for (double end = kSweep; end < 20; end += kSweep) {
    const MotionStep step = follower.sweep(end);
    EXPECT_TRUE(step.knows_attitude && step.knows_distance);
    ASSERT_LT((follower.position() - follower.true_position(end)).norm(), 1e-3) << end;
    const auto attitude = exponential({0, 0, drive.yaw_offset}) * drive.base(end).rotation;
    ASSERT_LT(step.attitude.angularDistance(attitude), 1e-4) << end;
    ASSERT_NEAR(step.distance, drive.distance(kSweep), 1e-6);
    for (double before = 0; before <= kSweep; before += 0.0033) {
      const SweepTrajectory::Transform place = follower.trajectory().at(std::llround(before * 1e9));
      const Pose truth = test::relative(drive.base(end), drive.base(end - before));
      ASSERT_LT((place.translation.cast<double>() - truth.translation).norm(), 2e-4) << before;
      ASSERT_LT((place.rotation.cast<double>() - truth.rotation.toRotationMatrix()).norm(), 2e-4);
    }
  }
}

TEST(DeadReckoning, FollowsACircle) {
  expect_exact(test::helix(1.5, 0.6, 0));
}

TEST(DeadReckoning, FollowsASlopeForwardsAndBackwards) {
  expect_exact(test::helix(1, 0, 0.3));
  expect_exact(test::helix(-1, 0, 0.3));
}

TEST(DeadReckoning, FollowsAHelixWhileTheRobotRolls) {
  expect_exact(test::helix(1.2, -0.5, -0.25, 0.15));
}

TEST(DeadReckoning, FollowsOverSweepsThatWereLost) {
  const SimpleDrive drive = test::helix(1.5, 0.6, 0.2);
  Follower follower(drive);
  drive.put(follower.sensors(), 0, 10.1);
  double seconds = 0;
  for (const double end : {kSweep, 0.5, 0.6, 3.0, 3.1, 10.0})
    seconds += follower.sweep(end).seconds();
  EXPECT_LT((follower.position() - follower.true_position(10)).norm(), 0.01);
  EXPECT_NEAR(seconds, 10, 1e-6);
}

TEST(DeadReckoning, CarriesOnWhereASensorIsSilent) {
  // A steady turn at a steady speed goes on as it was, whichever sensor is away.
  const SimpleDrive drive = test::helix(1, 0.4, 0);
  Follower follower(drive);
  drive.put_imu(follower.sensors(), 0, 3);
  drive.put_imu(follower.sensors(), 5, 10.1);
  drive.put_wheel(follower.sensors(), 0, 6);
  drive.put_wheel(follower.sensors(), 9, 10.1);
  follower.sensors().gather();
  for (int i = 1; i <= 100; ++i) {
    const MotionStep step = follower.sweep(kSweep * i);
    EXPECT_EQ(step.knows_attitude, i <= 31 || i >= 50) << i;
    EXPECT_EQ(step.knows_distance, i <= 61 || i >= 90) << i;
    ASSERT_LT((follower.position() - follower.true_position(kSweep * i)).norm(), 0.01) << i;
  }
}

TEST(DeadReckoning, TakesWhatIsAssumedForASilentSensor) {
  const SimpleDrive still = test::helix(0, 0, 0);
  Follower follower(still);
  still.put(follower.sensors(), 0, 0.5);
  for (int i = 1; i <= 7; ++i) follower.sweep(kSweep * i);
  follower.reckoning().assume_rate({0, 0, 0.5});
  follower.reckoning().assume_speed(2);
  EXPECT_EQ(follower.reckoning().speed(), 2);
  const MotionStep step = follower.sweep(0.8);
  EXPECT_FALSE(step.knows_attitude || step.knows_distance);
  EXPECT_NEAR(step.distance, 0.2, 1e-9);
  EXPECT_NEAR(step.rotation_angle(), 0.05, 1e-9);
  EXPECT_NEAR(yaw_of(step.attitude), 0.05, 1e-9);
  EXPECT_NEAR(step.displacement.y(), 0.2 * 0.025, 1e-5);
}

TEST(DeadReckoning, StandsWhereNoSensorEverSpeaks) {
  Follower follower(test::helix(1, 1, 0));
  for (int i = 1; i <= 10; ++i) {
    const MotionStep step = follower.sweep(kSweep * i);
    EXPECT_FALSE(step.knows_attitude || step.knows_distance);
    EXPECT_EQ(step.displacement, Eigen::Vector3d::Zero());
    EXPECT_EQ(step.attitude.angularDistance(Eigen::Quaterniond::Identity()), 0);
  }
}

/// The trajectory of a sweep in whose middle the IMU is heard, with another yaw than was believed.
void expect_whole(Follower& follower, const SimpleDrive& drive, double end) {
  const MotionStep step = follower.sweep(end);
  EXPECT_TRUE(step.knows_attitude);
  for (double before = 0; before <= kSweep; before += 0.01) {
    const SweepTrajectory::Transform place = follower.trajectory().at(std::llround(before * 1e9));
    const Pose truth = test::relative(drive.base(end), drive.base(end - before));
    EXPECT_LT((place.translation.cast<double>() - truth.translation).norm(), 0.01) << before;
    EXPECT_LT((place.rotation.cast<double>() - truth.rotation.toRotationMatrix()).norm(), 0.06)
        << before;
  }
  EXPECT_NEAR(step.rotation_angle(),
              drive.base(end - kSweep).rotation.angularDistance(drive.base(end).rotation), 0.06);
  const Eigen::Vector3d moved = step.begin_attitude.conjugate() * step.displacement;
  const Pose truth = test::relative(drive.base(end - kSweep), drive.base(end));
  EXPECT_LT((moved - truth.translation).norm(), 0.01);
}

TEST(DeadReckoning, ASweepIsNotTornWhenTheImuIsFirstHeardWithinIt) {
  SimpleDrive drive = test::helix(1, 0.4, 0.1);
  drive.yaw_offset = 2;
  Follower follower(drive);
  drive.put_wheel(follower.sensors(), 0, 1);
  drive.put_imu(follower.sensors(), 0.25, 1);
  follower.sensors().gather();
  follower.sweep(0.1);
  follower.sweep(0.2);
  expect_whole(follower, drive, 0.3);
}

TEST(DeadReckoning, ASweepIsNotTornWhenTheImuComesBackRestarted) {
  SimpleDrive drive = test::helix(1, 0.4, 0.1);
  Follower follower(drive);
  drive.put_wheel(follower.sensors(), 0, 3);
  drive.put_imu(follower.sensors(), 0, 1);
  drive.yaw_offset = -1.5;
  drive.put_imu(follower.sensors(), 2.05, 3);
  follower.sensors().gather();
  for (int i = 1; i <= 20; ++i) follower.sweep(kSweep * i);
  expect_whole(follower, drive, 2.1);
}

// The host's clock is set, and with it the times of all sensors.
TEST(DeadReckoning, GoesOnWhenTheClockIsSet) {
  constexpr double kHour = 3600, kYears = 50.0 * 365 * 24 * 3600;
  for (const double shift : {-kYears, -kHour, -5.0, 30.0, kHour, kYears}) {
    const SimpleDrive drive = test::helix(1, 0.3, 0.1);
    Follower follower(drive);
    drive.put(follower.sensors(), 0, 2);
    for (int i = 1; i < 20; ++i) follower.sweep(kSweep * i);
    for (int i = 0; i < 200; ++i) {
      ImuSample imu = drive.imu(2 + 0.01 * i);
      EncoderSample wheel = drive.wheel(2 + 0.01 * i);
      imu.t_ns += std::llround(shift * 1e9);
      wheel.t_ns += std::llround(shift * 1e9);
      follower.sensors().put(imu);
      follower.sensors().put(wheel);
    }
    follower.sensors().gather();
    for (int i = 21; i < 40; ++i) {
      const MotionStep step = follower.sweep(kSweep * i, shift);
      EXPECT_GE(step.seconds(), 0) << shift;
      EXPECT_LT(step.seconds(), 15) << shift;
      EXPECT_TRUE(step.knows_attitude && step.knows_distance) << shift << ' ' << i;
    }
    EXPECT_LT((follower.position() - follower.true_position(3.9)).norm(), 0.01) << shift;
  }
}

TEST(DeadReckoning, GoesBackWhenASweepIsRepeated) {
  const SimpleDrive drive = test::helix(1, 0.3, 0.1);
  Follower follower(drive);
  drive.put(follower.sensors(), 0, 2);
  for (const double end : {0.1, 0.2, 0.3, 0.2, 0.3, 0.4, 0.3, 0.3, 0.3, 0.4}) {
    const MotionStep step = follower.sweep(end);
    EXPECT_GE(step.seconds(), 0);
    EXPECT_LT((follower.position() - follower.true_position(end)).norm(), 1e-3) << end;
  }
}

TEST(DeadReckoning, TakesInstantsThatAreOneAndAllocatesNothing) {
  const SimpleDrive drive = test::helix(1, 0.3, 0.1);
  const std::size_t before = test::allocations();
  Follower follower(drive);
  drive.put(follower.sensors(), 0, 2);
  SweepTrajectory trajectory;
  const std::size_t made = test::allocations();
  for (const std::int64_t t : {nanoseconds(0.5), nanoseconds(0.5), nanoseconds(0.5) + 1}) {
    const MotionStep step = follower.reckoning().advance(follower.sensors(), t, t, trajectory);
    EXPECT_GE(step.seconds(), 0);
    EXPECT_LT(step.displacement.norm(), 1e-6);
    EXPECT_TRUE(trajectory.at(0).rotation.allFinite());
    EXPECT_TRUE(trajectory.at(100'000'000).rotation.allFinite());
  }
  follower.sweep(1.9);
  EXPECT_EQ(test::allocations(), made);
  EXPECT_GT(made, before);
}

/// The wheel of a robot that turns on the spot rolls round the middle.
TEST(DeadReckoningTest, KnowsWhereTheWheelIs) {
  const double beside = 0.3, rate = 0.5;
  test::SimpleDrive drive = test::helix(0, rate, 0);
  drive.distance = [=](double t) { return -rate * beside * t; };
  auto sensors = std::make_unique<SyncBuffer>();
  drive.put(*sensors, 0, 6);
  DeadReckoning reckoning(drive.imu_mount, {0, beside, 0});
  SweepTrajectory trajectory;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (double end = kSweep; end < 5.9; end += kSweep) {
    position += reckoning.advance(*sensors, nanoseconds(end - kSweep), nanoseconds(end), trajectory)
                    .displacement;
  }
  EXPECT_LT(position.norm(), 1e-3);
  EXPECT_NEAR(reckoning.speed(), 0, 1e-3);
}

}  // namespace
}  // namespace scree
