#include "scree/motion/calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "motion/simple_drive.hpp"

namespace scree {
namespace {

using test::kStart;
using test::nanoseconds;
using test::SimpleDrive;

/// Along x of `base`, in bends and over bumps where asked for, at a speed that changes.
SimpleDrive winding(double bends, double bumps) {
  constexpr double kStep = 0.002, kEnd = 62;  // seconds
  const auto speed = [](double t) { return 1 + 0.4 * std::sin(1.1 * t); };
  auto poses = std::make_shared<std::vector<Pose>>();
  auto ways = std::make_shared<std::vector<double>>();
  Pose base;
  double way = 0;
  for (double t = 0; t < kEnd; t += kStep) {
    base.rotation =
        from_roll_pitch_yaw(bumps * std::sin(1.3 * t), bumps * std::sin(1.9 * t + 1),
                            bends * (1 - std::cos(0.5 * t)) + bends * std::sin(0.31 * t));
    poses->push_back(base);
    ways->push_back(way);
    way += kStep * speed(t + kStep / 2);
    base.translation += base.rotation * Eigen::Vector3d(kStep * speed(t + kStep / 2), 0, 0);
  }
  SimpleDrive drive;
  drive.base = [=](double t) { return (*poses)[static_cast<std::size_t>(std::lround(t / kStep))]; };
  drive.distance = [=](double t) {
    return (*ways)[static_cast<std::size_t>(std::lround(t / kStep))];
  };
  return drive;
}

/// The robot as it is.
Settings robot() {
  Settings settings;
  settings.lidar.translation = {0.25, 0.04, 0.9};
  settings.lidar.rpy_deg = {-1, 6, 3};
  settings.imu.rpy_deg = {2, -1, 91};
  settings.encoder.scale = 0.002;
  settings.encoder.translation = {0, 0.3, 0};
  return settings;
}

/// The same, set wrong, as it was while the drive was recorded.
Settings wrong_robot() {
  Settings settings = robot();
  settings.lidar.translation = {0, 0.04, 0};
  settings.lidar.rpy_deg = {0, 0, -7};
  settings.imu.rpy_deg = {0, 0, -90};
  settings.encoder.scale = -0.004;
  settings.encoder.translation.setZero();
  return settings;
}

/// What sensors without any error record of it, from 1 s to `end`.
DriveRecord record(const SimpleDrive& drive, const Settings& is, const Settings& set, double end,
                   double imu_delay = 0) {
  const Pose mount = is.lidar.mount();
  DriveRecord record;
  for (double t = 1; t < end - 0.05; t += 0.1) {
    LidarStep step;
    step.begin_ns = nanoseconds(t);
    step.end_ns = nanoseconds(t + 0.1);
    step.step = test::relative(drive.base(t) * mount, drive.base(t + 0.1) * mount);
    step.is_bound = true;
    step.below =
        GroundPlane{mount.rotation.conjugate() * Eigen::Vector3d::UnitZ(), mount.translation.z()};
    record.steps.push_back(step);
  }
  for (std::size_t i = 1; i < record.steps.size(); ++i) {
    record.steps[i].begin_ns = record.steps[i - 1].end_ns;
  }
  const double place = is.encoder.translation.y();
  const double counted = set.encoder.scale / is.encoder.scale;
  for (double t = 0.8; t < end + 0.2; t += 0.01) {
    const Pose base = drive.base(t);
    record.imu.push_back({nanoseconds(t + imu_delay), base.rotation * is.imu.mount().rotation});
    record.wheel.push_back(
        {nanoseconds(t), counted * (drive.distance(t) - place * yaw_of(base.rotation))});
  }
  return record;
}

void expect_value(const Calibration& found, Calibrated which, double value, double off) {
  EXPECT_EQ(found[which].why_not, "") << static_cast<int>(which);
  EXPECT_NEAR(std::remainder(found[which].value - value, 360), 0, off) << static_cast<int>(which);
}

TEST(Calibrate, FindsEverythingThatADriveShows) {
  const Settings is = robot(), set = wrong_robot();
  const Calibration found = calibrate(record(winding(0.6, 0.05), is, set, 60, 0.012), set);
  for (int i = 0; i < 3; ++i) {
    const auto angle = [i](Calibrated first) {
      return static_cast<Calibrated>(static_cast<int>(first) + i);
    };
    expect_value(found, angle(Calibrated::lidar_roll), is.lidar.rpy_deg(i), 0.1);
    expect_value(found, angle(Calibrated::imu_roll), is.imu.rpy_deg(i), 0.2);
  }
  expect_value(found, Calibrated::lidar_x, 0.25, 0.01);
  expect_value(found, Calibrated::lidar_height, 0.9, 0.001);
  expect_value(found, Calibrated::encoder_scale, 0.002, 0.00001);
  expect_value(found, Calibrated::encoder_y, 0.3, 0.01);
  expect_value(found, Calibrated::imu_delay, 0.012, 0.002);
  expect_value(found, Calibrated::encoder_delay, 0, 0.003);
}

/// Samples carry their times less the delay that is set.
TEST(Calibrate, FindsADelayBesideTheOneThatIsSet) {
  Settings set = robot();
  set.imu.delay = 0.03;
  const DriveRecord drive = record(winding(0.6, 0.05), robot(), set, 60, 0.05 - set.imu.delay);
  const Calibration found = calibrate(drive, set);
  expect_value(found, Calibrated::imu_delay, 0.05, 0.002);
  EXPECT_TRUE(contradicts(found, set, Calibrated::imu_delay));
  EXPECT_NEAR(with_calibration(set, found).imu.delay, 0.05, 0.002);
  set.imu.delay = 0.09;
  EXPECT_EQ(with_calibration(set, calibrate(drive, set)).imu.delay, kMostDelay);
}

TEST(Calibrate, PutsRightWhatTheDriveContradictsAndNothingElse) {
  const Settings is = robot(), set = wrong_robot();
  const DriveRecord drive = record(winding(0.6, 0.05), is, set, 60);
  const Settings after = with_calibration(set, calibrate(drive, set));
  EXPECT_NEAR(after.lidar.translation.z(), 0.9, 0.001);
  EXPECT_EQ(after.lidar.translation.y(), set.lidar.translation.y());
  EXPECT_NEAR(after.imu.rpy_deg.z(), 91, 0.2);
  EXPECT_NEAR(after.encoder.scale, 0.002, 0.00001);
  EXPECT_EQ(after.imu.delay, 0);

  const DriveRecord right = record(winding(0.6, 0.05), is, is, 60);
  const Calibration found = calibrate(right, is);
  for (std::size_t i = 0; i < kCalibrated; ++i) {
    EXPECT_FALSE(contradicts(found, is, static_cast<Calibrated>(i))) << i;
  }
  EXPECT_EQ(with_calibration(is, found).lidar.rpy_deg, is.lidar.rpy_deg);
}

TEST(Calibrate, SaysWhatADriveDoesNotShow) {
  const Settings is = robot();
  // Straight on: neither places nor the IMU's yaw.
  const Calibration straight = calibrate(record(winding(0, 0), is, is, 60), is);
  for (const Calibrated which : {Calibrated::lidar_x, Calibrated::encoder_y, Calibrated::imu_yaw}) {
    EXPECT_NE(straight[which].why_not, "") << static_cast<int>(which);
    EXPECT_FALSE(contradicts(straight, is, which));
  }
  expect_value(straight, Calibrated::lidar_yaw, 3, 0.01);
  expect_value(straight, Calibrated::encoder_scale, 0.002, 0.00001);

  const Calibration flat = calibrate(record(winding(0.6, 0), is, is, 60), is);
  EXPECT_NE(flat[Calibrated::imu_yaw].why_not, "");
  expect_value(flat, Calibrated::lidar_x, 0.25, 0.01);
}

TEST(Calibrate, ADriveThatIsTooShortShowsNothing) {
  const Settings is = robot();
  for (const DriveRecord& drive : {DriveRecord(), record(winding(0.6, 0.05), is, is, 6)}) {
    const Calibration found = calibrate(drive, is);
    for (const CalibratedValue& value : found.values) {
      EXPECT_NE(value.why_not.find("ten seconds"), std::string_view::npos);
    }
    EXPECT_EQ(with_calibration(is, found).lidar.translation, is.lidar.translation);
  }
}

TEST(Calibrate, ASilentSensorIsNotShownAndSpoilsNothing) {
  const Settings is = robot();
  DriveRecord drive = record(winding(0.6, 0.05), is, is, 60);
  drive.imu.clear();
  drive.wheel.clear();
  const Calibration found = calibrate(drive, is);
  EXPECT_NE(found[Calibrated::imu_roll].why_not, "");
  EXPECT_NE(found[Calibrated::encoder_scale].why_not, "");
  expect_value(found, Calibrated::lidar_pitch, 6, 0.1);
}

TEST(Calibrate, WhereRegistrationLostItsWayCountsLittle) {
  const Settings is = robot();
  DriveRecord drive = record(winding(0.6, 0.05), is, is, 60);
  for (std::size_t i = 0; i < drive.steps.size(); i += 37) {
    drive.steps[i].step.translation += Eigen::Vector3d(0.3, -0.4, 0.2);
    drive.steps[i].below->normal = Eigen::Vector3d(0.3, 0.3, 0.9).normalized();
    drive.steps[i].below->height += 0.5;
  }
  const Calibration found = calibrate(drive, is);
  expect_value(found, Calibrated::lidar_yaw, 3, 0.5);
  expect_value(found, Calibrated::lidar_height, 0.9, 0.005);
  expect_value(found, Calibrated::encoder_scale, 0.002, 0.00002);
}

}  // namespace
}  // namespace scree
