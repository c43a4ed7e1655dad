#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "scree/core/rotation.hpp"
#include "scree/terrain/mapper.hpp"
#include "simulator/drive.hpp"

namespace scree {
namespace {

constexpr double kSeconds = 8;

/// What a robot's sensors said on a simulated drive with all their errors, sweep by sweep.
class Recorded {
public:
  explicit Recorded(std::uint64_t seed, Scene scene) {
    CaptureSettings settings;
    settings.seed = seed;
    settings.scene = scene;
    settings.seconds = kSeconds;
    settings.speed = 1;
    settings.cell = 0.06;
    settings.margin = 13;
    const Drive drive(settings);
    mapped_ = with_sensors_of(drive.robot, mapped_);
    DriveFeed feed(drive);
    const auto sensors = std::make_unique<SyncBuffer>();
    for (Sweep sweep(1 << 15); feed.next(sweep, {sensors.get()});) {
      Turn& turn = turns_.emplace_back();
      turn.sweep = Sweep(sweep.points.size());
      turn.sweep.end_ns = sweep.end_ns;
      for (std::size_t i = 0; i < sweep.points.size(); ++i) {
        turn.sweep.push_back({sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]},
                             sweep.points.reflectivity[i], sweep.time_ns[i], sweep.laser[i]);
      }
      sensors->gather();
      take_new(sensors->imu(), imu_until_, turn.imu);
      take_new(sensors->wheel(), wheel_until_, turn.wheel);
      turn.truth = drive.motion.base(sweep.end_ns);
    }
  }

  struct Fault {
    double begin = 0, end = 0;        ///< seconds
    bool imu = false, wheel = false;  ///< silent
    double spin = 0;                  ///< of the wheel, m/s too fast
  };
  struct Errors {
    double way = 0;                      ///< that was driven, metres
    double worst = 0, last = 0;          ///< metres
    double worst_yaw = 0, last_yaw = 0;  ///< degrees
  };
  Errors map(const Fault& fault, bool registers = true) const {
    Settings settings = mapped_;
    settings.map.registration = registers;
    Mapper mapper(settings);
    const auto sensors = std::make_unique<SyncBuffer>();
    const auto is_silent = [&](std::int64_t t_ns) {
      return since_start(t_ns) > fault.begin && since_start(t_ns) < fault.end;
    };
    Errors errors;
    Eigen::Quaterniond to_world = Eigen::Quaterniond::Identity();
    Eigen::Vector3d begin = Eigen::Vector3d::Zero(), before = begin;
    for (std::size_t i = 0; i < turns_.size(); ++i) {
      const Turn& turn = turns_[i];
      for (const ImuSample& sample : turn.imu) {
        if (!fault.imu || !is_silent(sample.t_ns)) sensors->put(sample);
      }
      for (EncoderSample sample : turn.wheel) {
        sample.distance +=
            fault.spin *
            (std::clamp(since_start(sample.t_ns), fault.begin, fault.end) - fault.begin);
        if (!fault.wheel || !is_silent(sample.t_ns)) sensors->put(sample);
      }
      sensors->gather();
      mapper.add(turn.sweep, *sensors);
      const Pose& pose = mapper.pose();
      if (i == 0) {
        to_world = exponential({0, 0, yaw_of(turn.truth.rotation) - yaw_of(pose.rotation)});
        begin = turn.truth.translation - to_world * pose.translation;
        before = turn.truth.translation;
      }
      errors.way += (turn.truth.translation - before).norm();
      before = turn.truth.translation;
      errors.last = (to_world * pose.translation + begin - turn.truth.translation).norm();
      errors.last_yaw = degrees(std::abs(std::remainder(
          yaw_of(to_world * pose.rotation) - yaw_of(turn.truth.rotation), 2 * std::numbers::pi)));
      errors.worst = std::max(errors.worst, errors.last);
      errors.worst_yaw = std::max(errors.worst_yaw, errors.last_yaw);
    }
    return errors;
  }

private:
  struct Turn {
    Sweep sweep;
    std::vector<ImuSample> imu;
    std::vector<EncoderSample> wheel;
    Pose truth;
  };

  template <class Sample>
  static void take_new(const SampleHistory<Sample>& history, std::int64_t& until,
                       std::vector<Sample>& samples) {
    for (std::size_t i = history.count_until(until); i < history.size(); ++i) {
      samples.push_back(history[i]);
    }
    until = history.newest().t_ns;
  }

  Settings mapped_;
  std::vector<Turn> turns_;
  std::int64_t imu_until_ = 0, wheel_until_ = 0;
};

// Sensors with all their errors; then each of them silent for as long as is asked for.
TEST(MapperDrive, StaysOnItsWayAndRecoversFromSilence) {
  const Recorded drive(2, Scene::rough);
  const Recorded::Errors whole = drive.map({});
  EXPECT_GT(whole.way, 5);
  EXPECT_LT(whole.worst, 0.02 * whole.way);
  EXPECT_LT(whole.worst_yaw, 0.5);
  EXPECT_LT(whole.last, drive.map({}, false).last) << "registration makes it no worse";

  const Recorded::Errors no_imu = drive.map({.begin = 3, .end = 5, .imu = true});
  EXPECT_LT(no_imu.worst, 0.2);
  EXPECT_LT(no_imu.worst_yaw, 3);
  EXPECT_LT(no_imu.last, whole.last + 0.1);
  EXPECT_LT(no_imu.last_yaw, 0.5);

  const Recorded::Errors no_wheel = drive.map({.begin = 3, .end = 6, .wheel = true});
  EXPECT_LT(no_wheel.worst, 0.3);
  EXPECT_LT(no_wheel.last, whole.last + 0.15);
  EXPECT_LT(no_wheel.last_yaw, 0.5);

  const Recorded::Errors spinning = drive.map({.begin = 3, .end = 4, .spin = 1});
  EXPECT_LT(spinning.worst, 0.2);
  EXPECT_LT(spinning.last, whole.last + 0.1);
  EXPECT_LT(spinning.last_yaw, 0.5);
}

}  // namespace
}  // namespace scree
