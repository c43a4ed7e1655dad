#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>

#include "scree/core/imu_sample.hpp"

namespace scree {

/// Gives an orientation to the samples of an IMU that sends none (MTi-1, MTi-10, MTi-100). It
/// integrates the rates. The specific force over a window of time, less what the robot speeds up
/// and turns by its wheel, is gravity; a Kalman filter corrects roll, pitch and the bias of the
/// rates by it. Yaw begins at zero, or where the last orientation was that the IMU sent, and
/// drifts.
class AttitudeFilter {
public:
  /// It answers when the IMU has sent no orientation for so long: one that does sends samples of
  /// high rate between, without.
  static constexpr std::int64_t kWithoutNs = 500'000'000;

  /// How much more than those of an IMU the turns between its orientations err: standard deviation,
  /// rad in a square root of a second. Chosen on simulated drives.
  static constexpr double kWalk = 0.006;

  /// Speed of the robot along its x axis at an instant, m/s; nothing where that is not known.
  using Speed = std::function<std::optional<double>(std::int64_t t_ns)>;

  /// @param mount rotation imu -> base
  explicit AttitudeFilter(const Eigen::Quaterniond& mount)
      : ahead_in_imu_(mount.conjugate() * Eigen::Vector3d::UnitX()) {}

  /// Takes the samples as they come. What has an orientation stays as it is.
  /// @param speed is asked for instants some 0.2 s before the sample
  /// @return whether the sample now has one; else it is of no use
  bool complete(ImuSample& sample, const Speed& speed);
  /// Whether the latest orientation was its own.
  bool answers() const { return answers_; }
  /// The clock was set back, or the IMU was silent.
  void restart();

private:
  static constexpr int kStates = 5;  // tilt about x and y of level (rad), bias of the rates (rad/s)
  using States = Eigen::Matrix<double, kStates, 1>;

  /// Where a window ends and the next begins.
  struct Bound {
    std::int64_t t_ns = 0;
    Eigen::Vector3d ahead = Eigen::Vector3d::Zero();  ///< x axis of `base`, in level
    Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< integral over the window before, m/s
  };
  void go_on_from(const ImuSample& sample);
  void begin_with(double tilt);
  void turn(const ImuSample& sample);
  void push(const Eigen::Vector3d& specific_force, std::int64_t t_ns);
  void close_window(const Speed& speed);
  void update(const Eigen::Vector3d& gravity, double deviation);
  void lean(const Eigen::Vector3d& rotation);

  Eigen::Vector3d ahead_in_imu_;
  Eigen::Quaterniond orientation_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();  // of the rate, rad/s
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();  // the last one, less the bias
  Eigen::Matrix<double, kStates, kStates> covariance_ =
      Eigen::Matrix<double, kStates, kStates>::Zero();
  std::int64_t begin_ns_ = 0, turned_ns_ = 0, pushed_ns_ = 0;
  bool has_turned_ = false, is_level_ = false, has_bound_ = false, waits_ = false;
  bool answers_ = false;
  Bound begin_, end_;  // of the last window, which waits for the wheel; equal: there is none yet
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();  // integral since end_
  std::optional<double> speed_;                      // at end_, or at begin_ while it waits
};

}  // namespace scree
