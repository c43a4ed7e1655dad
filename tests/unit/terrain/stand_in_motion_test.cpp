#include "scree/terrain/stand_in_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "allocation_counter.hpp"
#include "terrain/rough_ground.hpp"

namespace scree {
namespace {

constexpr double kTurn = 0.1;  // seconds

Settings turned_robot() {
  Settings settings;
  settings.lidar = test::usual_lidar();
  settings.imu.rpy_deg = {180, 0, 30};
  settings.encoder.translation = {0, 0.3, 0};
  return settings;
}

/// A robot that rolls and pitches on its way round a curve.
test::SimpleDrive swinging() {
  test::SimpleDrive drive = test::helix(0.8, 0.25, 0);
  drive.base = [level = drive.base](double t) {
    Pose pose = level(t);
    const Eigen::Quaterniond swing =
        from_roll_pitch_yaw(0.04 * std::sin(5 * t), 0.05 * std::sin(7 * t), 0);
    pose.rotation = pose.rotation * swing;
    return pose;
  };
  return drive;
}

class StandInMotionTest : public testing::Test {
protected:
  void go(int sweeps, double period = kTurn) {
    for (int i = 0; i < sweeps; ++i) {
      now_ += period;
      test::scan(ground_, drive_, settings_.lidar, now_, sweep_, 900);
      const bool follows = odometry_.add(sweep_);
      stand_in_.add(odometry_, follows, heard_);
    }
  }
  Eigen::Quaterniond attitude_at(double t) const {
    const auto attitude = stand_in_.samples().attitude_at(test::nanoseconds(t));
    if (!attitude) return Eigen::Quaterniond(0, 0, 0, 0);
    return attitude->rotation * settings_.imu.mount().rotation.conjugate();
  }

  Settings settings_ = turned_robot();
  test::RoughGround ground_{.roughness = 1.5};
  test::SimpleDrive drive_ = swinging();
  LidarOdometry odometry_{1 << 14, OwnReturns({}, Pose())};
  SyncBuffer heard_{settings_.imu.mount().rotation};
  StandInMotion stand_in_{settings_};
  Sweep sweep_{1 << 14};
  double now_ = 0;
};

TEST_F(StandInMotionTest, MeasuresAsImuAndEncoderWould) {
  go(10);
  const double from = now_;
  const auto way = [&](double t) {
    return stand_in_.samples().wheel_at(test::nanoseconds(t))->distance;
  };
  const double begin = way(from);
  go(20);
  for (double t = from + kTurn; t < now_; t += kTurn) {
    SCOPED_TRACE(t);
    const Eigen::Quaterniond turned = attitude_at(from).conjugate() * attitude_at(t);
    const Eigen::Quaterniond truth =
        drive_.base(from).rotation.conjugate() * drive_.base(t).rotation;
    EXPECT_LT(turned.angularDistance(truth), 0.03);
  }
  // The wheel is on the inside of the curve.
  EXPECT_NEAR(way(now_) - begin, (0.8 - 0.25 * 0.3) * (now_ - from), 0.05);
  EXPECT_GT(stand_in_.samples().attitude_walk(), 0);
}

TEST_F(StandInMotionTest, TakesTheWayFromAnEncoderThatIsHeard) {
  drive_.scale = 1.5;
  drive_.put_wheel(heard_, 0, 2);
  heard_.gather();
  go(20);
  const auto end = stand_in_.samples().wheel_at(test::nanoseconds(1.9));
  const auto begin = stand_in_.samples().wheel_at(test::nanoseconds(0.9));
  ASSERT_TRUE(begin && end);
  EXPECT_NEAR(end->distance - begin->distance,
              heard_.wheel_at(test::nanoseconds(1.9))->distance -
                  heard_.wheel_at(test::nanoseconds(0.9))->distance,
              1e-6);
}

TEST_F(StandInMotionTest, SlowTurnsOfTheLidarLeaveNoSilence) {
  go(8, 0.2);
  for (double t = 0.4; t < now_; t += 0.05) {
    EXPECT_TRUE(stand_in_.samples().attitude_at(test::nanoseconds(t))) << t;
    EXPECT_TRUE(stand_in_.samples().wheel_at(test::nanoseconds(t))) << t;
  }
}

TEST_F(StandInMotionTest, LaysTheGroundAroundLevel) {
  ground_.roughness = 0;
  drive_.base = [](double) { return Pose{{0, 0, 0}, from_roll_pitch_yaw(0.1, -0.07, 0)}; };
  go(1);
  EXPECT_LT((attitude_at(now_) * Eigen::Vector3d::UnitZ() -
             drive_.base(0).rotation * Eigen::Vector3d::UnitZ())
                .norm(),
            0.01);
}

TEST_F(StandInMotionTest, SettlesOnceWhereTheGroundShowsTheWay) {
  int settled = 0;
  for (int i = 0; i < 25; ++i) {
    go(1);
    EXPECT_TRUE(stand_in_.is_bound());
    settled += stand_in_.settles() ? 1 : 0;
  }
  EXPECT_EQ(settled, 1);
}

TEST_F(StandInMotionTest, APlaneDoesNotBindIt) {
  ground_.roughness = 0;
  go(1);
  EXPECT_TRUE(stand_in_.is_bound()) << "believed at first";
  go(12);
  EXPECT_FALSE(stand_in_.is_bound());
  EXPECT_FALSE(stand_in_.settles());
}

TEST_F(StandInMotionTest, AllocatesNothing) {
  const std::size_t before = test::allocations();
  go(3);
  now_ += 5;
  go(3);
  now_ -= 60;
  go(3);
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace scree
