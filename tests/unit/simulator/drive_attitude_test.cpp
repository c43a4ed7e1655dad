#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "scree/core/nanoseconds.hpp"
#include "simulator/drive.hpp"

namespace scree {
namespace {

/// Greatest angle between the true vertical and that of the sensors' attitude, from 5 s on.
double worst_tilt(CaptureSettings settings) {
  settings.cell = 0.1;
  settings.margin = 2;
  const Drive drive(settings);
  const Eigen::Quaterniond mount = drive.robot.imu_mount().rotation;
  const auto sensors = std::make_unique<SyncBuffer>(mount);
  DriveFeed feed(drive, DriveFeed::kNoFaults);
  double worst = 0;
  for (Sweep sweep(1 << 15); feed.next(sweep, {sensors.get()});) {
    sensors->gather();
    if (sweep.end_ns < kDriveStartNs + 5 * kSecond) continue;
    const auto attitude = sensors->attitude_at(sweep.end_ns);
    if (!attitude) return 4;
    const Eigen::Vector3d up = mount * (attitude->rotation.conjugate() * Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d true_up =
        drive.motion.base(sweep.end_ns).rotation.conjugate() * Eigen::Vector3d::UnitZ();
    worst = std::max(worst, up.cross(true_up).norm());
  }
  return worst;
}

/// The IMU's own attitude is off by 0.4 degrees at most, one standard deviation.
TEST(DriveAttitude, OfRatesAndAccelerationsIsNearlyAsGoodAsTheImusOwn) {
  CaptureSettings settings;
  settings.seconds = 15;
  settings.scene = Scene::rolling;
  EXPECT_LT(worst_tilt(settings), 0.02);
  settings.imu_orientation = false;
  EXPECT_LT(worst_tilt(settings), 0.03);
}

}  // namespace
}  // namespace scree
