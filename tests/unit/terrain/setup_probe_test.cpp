#include "scree/terrain/setup_probe.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "allocation_counter.hpp"
#include "terrain/rough_ground.hpp"

namespace scree {
namespace {

constexpr double kSweep = 0.1;  // seconds

Settings robot() {
  Settings settings;
  settings.lidar = test::usual_lidar();
  settings.memory.sweep_points = 1 << 13;
  return settings;
}

/// A robot that drives off straight ahead, and is 0.8 m/s fast after two seconds.
test::SimpleDrive start_of_a_drive() {
  test::SimpleDrive drive;
  drive.distance = [](double t) { return t < 2 ? 0.2 * t * t : 0.8 * (t - 1); };
  drive.base = [way = drive.distance](double t) {
    const double roll = 0.04 * std::sin(2 * t), pitch = 0.03 * std::sin(2.7 * t);
    return Pose{{way(t), 0, 0}, from_roll_pitch_yaw(roll, pitch, 0)};
  };
  return drive;
}

/// A plane says nothing of the way along it.
TEST(LidarOdometryTest, SaysWhereTheGroundBindsTooLittle) {
  const test::SimpleDrive drive = start_of_a_drive();
  LidarOdometry odometry(1 << 13, OwnReturns({}, Pose()));
  Sweep sweep(1 << 13);
  for (double end = kSweep; end < 3; end += kSweep) {
    test::scan(test::RoughGround{.roughness = 0}, drive, test::usual_lidar(), end, sweep, 200);
    odometry.add(sweep);
    EXPECT_FALSE(odometry.is_bound());
  }
}

/// The same drive with three settings: right ones, a lidar that looks elsewhere, a wrong scale.
TEST(SetupProbeTest, NamesWhatIsWrongAndNothingElse) {
  const Settings right = robot();
  Settings askew = right;
  askew.lidar.rpy_deg.z() = 10;
  test::SimpleDrive drive = start_of_a_drive();
  const auto sensors = std::make_unique<SyncBuffer>(), doubled = std::make_unique<SyncBuffer>();
  drive.put(*sensors, 0, 7);
  drive.scale = 2;
  drive.put(*doubled, 0, 7);
  SetupProbe of_right(right), of_askew(askew), of_doubled(right);
  Sweep sweep(1 << 13);
  std::size_t allocated = 0;
  double off = 0;
  for (double end = kSweep; end < 6.5; end += kSweep) {
    test::scan(test::RoughGround(), drive, right.lidar, end, sweep, 500);
    const std::size_t before = test::allocations();
    of_right.add(sweep, *sensors);
    of_askew.add(sweep, *sensors);
    of_doubled.add(sweep, *doubled);
    allocated += test::allocations() - before;
    if (end < 3 || !of_right.odometry().is_bound()) continue;
    const Pose step = test::relative(drive.base(end - kSweep) * right.lidar.mount(),
                                     drive.base(end) * right.lidar.mount());
    off = std::max(off, (of_right.odometry().step().translation - step.translation).norm());
  }
  EXPECT_EQ(allocated, 0U);
  EXPECT_GT(off, 0);
  EXPECT_LT(off, 0.03);
  EXPECT_EQ(of_right.report().count, 0U);
  ASSERT_EQ(of_askew.report().count, 1U);
  EXPECT_EQ(of_askew.report().findings[0].fault, SetupFault::lidar_rotation);
  EXPECT_NEAR(of_askew.report().findings[0].set.z(), 0, 2);
  ASSERT_EQ(of_doubled.report().count, 1U);
  EXPECT_EQ(of_doubled.report().findings[0].fault, SetupFault::encoder_scale);
  EXPECT_NEAR(of_doubled.report().findings[0].off, 2, 0.1);
}

}  // namespace
}  // namespace scree
