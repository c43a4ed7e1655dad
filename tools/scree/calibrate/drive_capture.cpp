#include "calibrate/drive_capture.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "commands.hpp"
#include "detection/waiting_sweeps.hpp"
#include "read/lidar_capture.hpp"
#include "read/motion_capture.hpp"
#include "scree/motion/sync_buffer_of.hpp"
#include "scree/terrain/lidar_odometry.hpp"

namespace scree::cli {
namespace {

constexpr std::size_t kEvery = 20;              // sweeps, of which one is kept
constexpr std::int64_t kSpacingNs = 5'000'000;  // of what is kept of IMU and wheel

/// Follows the sensors from sweep to sweep.
class Recorder {
public:
  Recorder(const Settings& settings, const SyncBuffer& sensors)
      : sensors_(sensors),
        middle_(LidarOdometry::above_middle(settings.lidar.mount())),
        odometry_(static_cast<std::size_t>(settings.memory.sweep_points),
                  OwnReturns(settings.robot.body, settings.lidar.mount())) {}

  void add(const Sweep& sweep) {
    keep_motion_until(sweep.end_ns);
    if (!odometry_.add(sweep)) return;
    drive_.record.steps.push_back({odometry_.begin_ns(), odometry_.end_ns(), odometry_.step(),
                                   odometry_.is_bound(), odometry_.ground_below(middle_)});
    if (drive_.record.steps.size() % kEvery == 1) keep_near(odometry_.sweep().points);
  }
  DriveCapture& drive() { return drive_; }

private:
  void keep_motion_until(std::int64_t end_ns) {
    constexpr std::int64_t kLongestNs = 500'000'000;
    for (next_ns_ = std::max(next_ns_, end_ns - kLongestNs); next_ns_ <= end_ns;
         next_ns_ += kSpacingNs) {
      if (const auto attitude = sensors_.attitude_at(next_ns_)) {
        drive_.record.imu.push_back({next_ns_, attitude->rotation});
      }
      if (const auto wheel = sensors_.wheel_at(next_ns_)) {
        drive_.record.wheel.push_back({next_ns_, wheel->distance});
      }
    }
  }

  void keep_near(const PointCloud& points) {
    constexpr float kFar = 6;  // metres
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::hypot(points.x[i], points.y[i]) > kFar) continue;
      drive_.near.emplace_back(points.x[i], points.y[i], points.z[i]);
    }
  }

  const SyncBuffer& sensors_;
  Eigen::Vector3d middle_;  // above the robot's, at the lidar's height, in `lidar`
  LidarOdometry odometry_;
  std::int64_t next_ns_ = 0;
  DriveCapture drive_;
};

}  // namespace

DriveCapture read_drive(const std::filesystem::path& capture, const std::filesystem::path& config,
                        const Settings& settings) {
  const HostSteps steps = find_host_steps(capture, settings.lidar);
  LidarCapture lidar(capture, settings, steps);
  const auto sensors = sync_buffer_of(settings);
  MotionCapture motion(capture, config, settings, *sensors, steps);
  Recorder recorder(settings, *sensors);
  WaitingSweeps waiting(settings.motion_wait(), *sensors, [&](const Sweep& sweep) {
    sensors->gather();
    recorder.add(sweep);
  });
  std::int64_t now_ns = 0;
  velodyne::LidarStream stream(settings.lidar, [&](Sweep& sweep) {
    if (!sweep.points.empty()) waiting.push(sweep, now_ns);
  });
  lidar.play(stream, {}, [&](std::int64_t arrival_ns) {
    now_ns = arrival_ns;
    motion.play_until(arrival_ns);
    waiting.process_ready(arrival_ns);
  });
  waiting.process_all();
  motion.finish();
  report_capture(lidar, stream);
  motion.report(lidar.span());
  return std::move(recorder.drive());
}

}  // namespace scree::cli
