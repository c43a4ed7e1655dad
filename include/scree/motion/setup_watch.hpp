#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "scree/config/settings.hpp"
#include "scree/motion/setup_report.hpp"
#include "scree/motion/setup_window.hpp"

namespace scree {

/// Names the settings that the sensors contradict: mounts, and the encoder's scale, sign and place.
/// It holds what each sensor measured by itself against the others, never what was made of all of
/// them: a wrong setting would have drawn that along.
///
/// Each setting is judged anew after each window, over the windows of the latest seven seconds in
/// which the robot moved:
///
/// | state    | goes on when                                                              |
/// |----------|---------------------------------------------------------------------------|
/// | not named| wrong as often in a row as it was right before, at least 2, at most 20    |
/// |          | times: named                                                              |
/// | named    | right 4 times in a row: not named                                         |
///
/// What cannot be judged changes nothing.
class SetupWatch {
public:
  explicit SetupWatch(const Settings& settings);

  /// Takes one window after the other.
  void add(const SetupWindow& window);

  const SetupReport& report() const { return report_; }

private:
  static constexpr std::size_t kWindows = 14;
  static constexpr int kLongTurns = 4;

  /// A window in which the robot moved, in `base` by the mounts that are set.
  struct Seen {
    double seconds = 0;
    bool is_bound = false, binds = false, has_imu = false, has_force = false, has_wheel = false;
    bool has_change = false;
    Eigen::Vector3d way, turn;         // of `base`, by the lidar
    Eigen::Vector3d imu_turn, imu_up;  // by the IMU
    // Turns summed up with those of the windows before, from every kLongTurns-th on.
    Eigen::Vector3d long_turn, long_imu_turn;
    int long_turns = 0;
    Eigen::Vector3d force, mean_force;  // less gravity, m/s^2; with that of the window before
    Eigen::Vector3d change;             // of the velocity since then, by the lidar, m/s^2
    double wheel = 0;                   // metres
    Eigen::Vector3d imu_turn_gain;      // since SetupWindow::kBefore
    double wheel_gain = 0;
    std::optional<GroundPlane> around, below;
  };
  enum class Word : std::uint8_t { unknown, right, wrong };
  /// What one look says of a setting.
  struct Verdict {
    Word word = Word::unknown;
    SetupFinding finding;
  };
  /// The state of one setting.
  struct Belief {
    int rights = 0, rights_in_row = 0, wrongs_in_row = 0;
    bool is_named = false;
    SetupFinding finding;
    void update(const Verdict& verdict);
  };
  /// The sum of the ways that go the same way while driving straight, as if forwards.
  struct Travel {
    Eigen::Vector3d way = Eigen::Vector3d::Zero();
    int windows = 0;
  };
  /// Medians: metres, and degrees that the mount lacks to lay the ground level. The angles are zero
  /// where they differ from window to window.
  struct Ground {
    double height = 0, roll = 0, pitch = 0;
    int windows = 0;
  };
  /// Squares of what the IMU leaves unexplained, and of all there is to explain.
  struct Fit {
    double squares = 0, all = 0;
  };
  /// The wheel's way for each metre of the robot's, and for each radian that it turns to the left.
  struct WheelFit {
    double by_way = 0, by_turn = 0;
    double turn_deviation = 0;   ///< standard deviation of by_turn, metres
    double residual = 0;         ///< share of the wheel's way
    double way = 0, turns = 0;   ///< metres; rad^2
    int windows = 0, aside = 0;  ///< that tell, and that do not for the lidar went aside
  };

  /// How much later a sensor is than the lidar, seconds.
  struct DelayFit {
    double delay = 0, deviation = 0;
    double balance = 0;      ///< share of the rarer direction of gains in what tells the delay
    double unexplained = 1;  ///< share of the squares of what the sensor is behind
  };
  /// What a sensor is behind the lidar, and what it gains in a second.
  class Lags {
  public:
    void add(double behind, double gain);
    /// A line through zero, for which what fits badly counts less.
    /// @param noise what may be behind without a delay
    DelayFit fit(double noise) const;

  private:
    static constexpr std::size_t kMost = 3 * kWindows;
    std::array<double, kMost> behind_, gain_;
    std::size_t count_ = 0;
  };

  std::span<const Seen> windows() const { return {ring_.data(), std::min(count_, kWindows)}; }
  Seen seen_in_base(const SetupWindow& window) const;
  Belief& belief(SetupFault fault) { return beliefs_[static_cast<std::size_t>(fault)]; }
  const Belief& belief(SetupFault fault) const { return beliefs_[static_cast<std::size_t>(fault)]; }
  void judge();
  void update_report();
  Travel travel() const;
  Ground ground(std::optional<GroundPlane> Seen::*which) const;
  Verdict judge_lidar_height() const;
  Verdict judge_lidar_rotation() const;
  Fit fit_imu(const Eigen::Matrix3d& hypothesis) const;
  Verdict judge_imu_rotation() const;
  bool goes_aside(const Seen& seen) const;
  WheelFit fit_wheel() const;
  Verdict judge_encoder_scale(const WheelFit& fit) const;
  Verdict judge_encoder_place(const WheelFit& fit) const;
  Verdict judge_delay(const DelayFit& fit, SetupFault fault, double set) const;
  Verdict judge_imu_delay() const;
  Verdict judge_encoder_delay(const WheelFit& fit) const;

  Pose lidar_mount_;
  Eigen::Matrix3d lidar_, imu_;  // rotations into `base`
  double encoder_scale_;
  Eigen::Vector3d encoder_place_;
  double imu_delay_, encoder_delay_;               // seconds
  std::array<Eigen::Matrix3d, 24> quarter_turns_;  // none first, then half turns
  std::array<Seen, kWindows> ring_;
  std::size_t count_ = 0;       // of windows since the start
  std::optional<Seen> before_;  // the window before
  std::array<Belief, kSetupFaults> beliefs_;
  SetupReport report_;
};

}  // namespace scree
