#pragma once

#include <cmath>
#include <cstdint>
#include <functional>

#include "scree/core/pose.hpp"
#include "scree/core/rotation.hpp"
#include "scree/sync/sync_buffer.hpp"

namespace scree::test {

inline constexpr std::int64_t kStart = 1'598'612'523'000'000'000;

inline std::int64_t nanoseconds(double seconds) {
  return kStart + std::llround(seconds * 1e9);
}

/// A way of `base` as formulas have it, in a level frame, over seconds since kStart; and what
/// sensors without any error say about it.
struct SimpleDrive {
  std::function<Pose(double)> base;
  std::function<double(double)> distance;  ///< metres along x of `base`
  Eigen::Quaterniond imu_mount = Eigen::Quaterniond::Identity();
  Eigen::Vector3d imu_translation = Eigen::Vector3d::Zero();  ///< in `base`, metres
  double yaw_offset = 0;                                      ///< of the IMU's level frame, rad
  Eigen::Quaterniond lean = Eigen::Quaterniond::Identity();   ///< by which that frame is wrong
  double scale = 1;                                           ///< of the wheel

  Eigen::Vector3d rate(double t) const {
    constexpr double kHalf = 1e-4;
    return logarithm(base(t - kHalf).rotation.conjugate() * base(t + kHalf).rotation) / (2 * kHalf);
  }
  /// What the IMU feels, in the level frame, m/s^2.
  Eigen::Vector3d specific_force(double t) const {
    constexpr double kHalf = 1e-3, kGravity = 9.81;
    const auto place = [&](double at) { return base(at) * imu_translation; };
    return (place(t + kHalf) - 2 * place(t) + place(t - kHalf)) / (kHalf * kHalf) +
           Eigen::Vector3d(0, 0, kGravity);
  }
  ImuSample imu(double t) const {
    ImuSample sample;
    sample.t_ns = nanoseconds(t);
    sample.has_orientation = sample.has_rate = sample.has_acceleration = true;
    sample.orientation = exponential({0, 0, yaw_offset}) * lean * base(t).rotation * imu_mount;
    sample.rate = imu_mount.conjugate() * rate(t);
    sample.acceleration = (base(t).rotation * imu_mount).conjugate() * specific_force(t);
    return sample;
  }
  EncoderSample wheel(double t) const {
    EncoderSample sample;
    sample.t_ns = nanoseconds(t);
    sample.distance = sample.value = scale * distance(t);
    return sample;
  }
  /// Samples of both at 100 Hz, from `begin` to before `end`, seconds.
  void put(SyncBuffer& sensors, double begin, double end) const {
    put_imu(sensors, begin, end);
    put_wheel(sensors, begin, end);
    sensors.gather();
  }
  void put_imu(SyncBuffer& sensors, double begin, double end) const {
    for (int i = static_cast<int>(std::lround(100 * begin)); i < std::lround(100 * end); ++i) {
      sensors.put(imu(0.01 * i));
    }
  }
  void put_wheel(SyncBuffer& sensors, double begin, double end) const {
    for (int i = static_cast<int>(std::lround(100 * begin)); i < std::lround(100 * end); ++i) {
      sensors.put(wheel(0.01 * i));
    }
  }
};

/// Round a circle to the left and, with a slope, up a helix; m/s, rad/s, rad. The robot rolls from
/// side to side meanwhile by `roll` radians.
inline SimpleDrive helix(double speed, double turn, double slope, double roll = 0) {
  SimpleDrive drive;
  drive.base = [=](double t) {
    const double level = speed * std::cos(slope);
    const double x = turn == 0 ? level * t : level / turn * std::sin(turn * t);
    const double y = turn == 0 ? 0 : level / turn * (1 - std::cos(turn * t));
    return Pose{{x, y, speed * std::sin(slope) * t},
                from_roll_pitch_yaw(roll * std::sin(3 * t), -slope, turn * t)};
  };
  drive.distance = [speed](double t) { return speed * t; };
  return drive;
}

/// The second in the frame of the first.
inline Pose relative(const Pose& a, const Pose& b) {
  return {a.rotation.conjugate() * (b.translation - a.translation),
          a.rotation.conjugate() * b.rotation};
}

}  // namespace scree::test
