#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "scree/core/nanoseconds.hpp"
#include "simulator/drive.hpp"
#include "simulator/imu.hpp"

namespace scree {
namespace {

/// Greatest angle between the true vertical and that of the sensors' attitude, from 5 s on.
double worst_tilt(CaptureSettings settings) {
  settings.cell = 0.1;
  settings.margin = 2;
  const Drive drive(settings);
  const Pose mount = drive.robot.imu_mount();
  const auto sensors = std::make_unique<SyncBuffer>(mount.rotation);
  SimulatedImu imu(drive.motion, mount, draw_imu(settings), kDriveStartNs, settings.seed);
  Pose before = drive.motion.base(kDriveStartNs);
  double worst = 0, rolled = 0;
  const std::int64_t end_ns = kDriveStartNs + static_cast<std::int64_t>(settings.seconds * 1e9);
  for (ImuMessage sent = imu.next(); sent.t_ns < end_ns; sent = imu.next()) {
    const Pose now = drive.motion.base(sent.t_ns);
    rolled += (now.rotation.conjugate() * (now.translation - before.translation)).x();
    before = now;
    sensors->put(EncoderSample{.t_ns = sent.t_ns, .distance = rolled});
    sensors->put(sample_of(sent));
    sensors->gather();
    if (sent.t_ns < kDriveStartNs + 5 * kSecond) continue;
    const auto attitude = sensors->attitude_at(sent.t_ns);
    if (!attitude) return 4;
    const Eigen::Vector3d up =
        mount.rotation * (attitude->rotation.conjugate() * Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d true_up = now.rotation.conjugate() * Eigen::Vector3d::UnitZ();
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
