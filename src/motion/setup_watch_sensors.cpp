#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scree/core/pose.hpp"
#include "scree/motion/setup_watch.hpp"
#include "setup_angles.hpp"

namespace scree {
namespace {

/// Squares of vectors that two sensors measured, and of what is between them, in units of what may
/// be between them.
struct Contradiction {
  double squares = 0, all = 0;
  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& tolerance) {
    squares += (a - b).cwiseQuotient(tolerance).squaredNorm();
    all += a.cwiseQuotient(tolerance).squaredNorm();
  }
};

/// What may be between two measurements of a turn: more in the direction of its own part, level or
/// upright, and a little of the other, where a mount is off by some degrees.
Eigen::Vector3d turn_tolerance(const Eigen::Vector3d& turn, double noise) {
  constexpr double kShare = 0.15, kOther = 0.05;
  const double level = turn.head<2>().norm(), upright = std::abs(turn.z());
  const double of_level = noise + kShare * level + kOther * upright;
  return {of_level, of_level, noise + kShare * upright + kOther * level};
}

}  // namespace

/// How far the IMU is from the lidar and the ground if it had to be turned by `hypothesis` first.
SetupWatch::Fit SetupWatch::fit_imu(const Eigen::Matrix3d& hypothesis) const {
  constexpr double kTurn = 0.003, kLongTurn = 0.006;   // rad, in a window and in two seconds
  constexpr double kChange = 0.1, kChangeShare = 0.3;  // m/s^2
  constexpr double kSlope = 0.5;                       // of the ground against the vertical, rad
  Contradiction sum;
  for (const Seen& seen : windows()) {
    if (!seen.is_bound || !seen.has_imu) continue;
    sum.add(seen.turn, hypothesis * seen.imu_turn, turn_tolerance(seen.turn, kTurn));
    if (seen.long_turns == kLongTurns) {
      sum.add(seen.long_turn, hypothesis * seen.long_imu_turn,
              turn_tolerance(seen.long_turn, kLongTurn));
    }
    if (seen.around) {
      sum.add(seen.around->normal, hypothesis * seen.imu_up, Eigen::Vector3d::Constant(kSlope));
    }
    if (!seen.has_change) continue;
    Eigen::Vector3d lidar = seen.change, imu = hypothesis * seen.mean_force;
    lidar.z() = imu.z() = 0;  // shaken
    const double change = kChange + kChangeShare * std::max(lidar.norm(), imu.norm());
    sum.add(lidar, imu, Eigen::Vector3d::Constant(change));
  }
  return {sum.squares, sum.all};
}

SetupWatch::Verdict SetupWatch::judge_imu_rotation() const {
  // By how much another hypothesis must be better. Simulated right drives stay below 3 of it.
  constexpr double kClear = 15, kTimes = 2.5;
  constexpr double kAlike = 10;  // of two that are that close the simpler one is taken
  constexpr double kExplained = 0.5;
  constexpr int kLeast = 3;
  const auto known = std::ranges::count_if(
      windows(), [](const Seen& seen) { return seen.is_bound && seen.has_imu; });
  if (known < kLeast) return {};
  std::array<double, 24> squares{};
  for (std::size_t i = 0; i < squares.size(); ++i) squares[i] = fit_imu(quarter_turns_[i]).squares;
  const double least = *std::ranges::min_element(squares);
  if (squares[0] <= kTimes * least + kClear) {
    const double second = *std::min_element(squares.begin() + 1, squares.end());
    return {second > kTimes * squares[0] + kClear ? Word::right : Word::unknown, {}};
  }
  if (least > kExplained * fit_imu(quarter_turns_[0]).all) return {};
  const auto simplest =
      std::ranges::find_if(squares, [&](double each) { return each <= least + kAlike; });
  const Eigen::Matrix3d& turn =
      quarter_turns_[static_cast<std::size_t>(simplest - squares.begin())];
  const Eigen::AngleAxisd about(turn);
  return {Word::wrong,
          {.fault = SetupFault::imu_rotation,
           .is_grave = true,
           .off = degrees(about.angle()),
           .axis = about.axis(),
           .set = roll_pitch_yaw_deg(turn * imu_)}};
}

/// A wheeled robot does not go sideways. Where the lidar says so it has lost its way, as among
/// people, or it is mounted askew.
bool SetupWatch::goes_aside(const Seen& seen) const {
  constexpr double kMostAside = 0.3, kNoise = 0.1;  // of the way ahead; m/s
  return !belief(SetupFault::lidar_rotation).is_named &&
         std::abs(seen.way.y()) > kMostAside * std::abs(seen.way.x()) + kNoise * seen.seconds;
}

/// A wheel rolls as far as its place moves: by the way of `base`, and in turns by its distance from
/// the middle. A least-squares fit in which windows that fit badly count less.
SetupWatch::WheelFit SetupWatch::fit_wheel() const {
  constexpr double kLeastSpeed = 0.15, kLeastRate = 0.15;  // m/s, rad/s
  constexpr double kPrior = 1e-4, kPriorTurn = 1e-3;       // m^2, rad^2: where there are none
  constexpr double kLeastScale = 0.015;                    // metres
  constexpr int kRounds = 4;
  WheelFit fit;
  std::array<double, kWindows> errors{};
  Eigen::Vector2d factors = Eigen::Vector2d::Zero();
  double scale = 0;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix2d information = Eigen::Vector2d(kPrior, kPriorTurn).asDiagonal();
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    double squares = 0, error_squares = 0;
    fit.way = fit.turns = 0;
    fit.windows = fit.aside = 0;
    for (const Seen& seen : windows()) {
      const double way = std::copysign(seen.way.norm(), seen.way.x());
      const Eigen::Vector2d moved(way, seen.turn.z());
      if (!seen.is_bound || !seen.has_wheel) continue;
      if (goes_aside(seen)) {
        ++fit.aside;
        continue;
      }
      if (std::abs(way) < kLeastSpeed * seen.seconds &&
          std::abs(moved.y()) < kLeastRate * seen.seconds) {
        continue;
      }
      const double error = seen.wheel - factors.dot(moved);
      const double weight = round == 0 ? 1 : 1 / (1 + error * error / (scale * scale));
      information += weight * moved * moved.transpose();
      gradient += weight * seen.wheel * moved;
      squares += seen.wheel * seen.wheel;
      error_squares += error * error;
      errors[static_cast<std::size_t>(fit.windows++)] = std::abs(error);
      fit.way += std::abs(way);
      fit.turns += moved.y() * moved.y();
    }
    if (fit.windows == 0) return fit;
    fit.residual = std::sqrt(error_squares / std::max(squares, 1e-9));
    const auto middle = errors.begin() + fit.windows / 2;
    std::nth_element(errors.begin(), middle, errors.begin() + fit.windows);
    scale = std::max(kLeastScale, 1.5 * *middle);
    factors = information.ldlt().solve(gradient);
    fit.turn_deviation = scale * std::sqrt(information.inverse()(1, 1));
  }
  if (2 * fit.aside > fit.windows) return {};
  fit.by_way = factors.x();
  fit.by_turn = factors.y();
  return fit;
}

// Simulated right drives stay within 22 % of the scale, and 0.1 m of the place, up to 0.18 m where
// the lidar lost its way. A wheel that slips more than now and then fits badly.
constexpr double kMostResidual = 0.25;
constexpr int kLeastWindows = 5;

SetupWatch::Verdict SetupWatch::judge_encoder_scale(const WheelFit& fit) const {
  constexpr double kLeastWay = 1;  // metres
  constexpr double kOff = 0.3, kRight = 0.15;
  constexpr double kStands = 0.1;  // the wheel, or its counter
  const double off = std::abs(fit.by_way - 1);
  if (fit.windows < kLeastWindows || fit.way < kLeastWay) return {};
  if (fit.residual > kMostResidual || std::abs(fit.by_way) < kStands) return {};
  if (off < kOff) return {off < kRight ? Word::right : Word::unknown, {}};
  return {Word::wrong,
          {.fault = SetupFault::encoder_scale,
           .is_grave = true,
           .off = fit.by_way,
           .set = {encoder_scale_ / fit.by_way, 0, 0}}};
}

SetupWatch::Verdict SetupWatch::judge_encoder_place(const WheelFit& fit) const {
  constexpr double kLeastTurns = 0.3;                           // rad^2
  constexpr double kOff = 0.2, kRight = 0.12, kFarthest = 2.5;  // metres
  constexpr double kDeviations = 2;
  if (fit.windows < kLeastWindows || fit.turns < kLeastTurns) return {};
  if (fit.residual > kMostResidual || std::abs(fit.by_way - 1) > kMostResidual) return {};
  const double y = -fit.by_turn / fit.by_way, off = y - encoder_place_.y();
  if (std::abs(off) > kFarthest) return {};
  // A lidar that loses its way now and then tells a place that scatters.
  const double doubt = kDeviations * fit.turn_deviation / std::abs(fit.by_way);
  if (std::abs(off) < kOff + doubt) {
    return {std::abs(off) < kRight ? Word::right : Word::unknown, {}};
  }
  return {Word::wrong,
          {.fault = SetupFault::encoder_place,
           .off = -off,
           .set = {encoder_place_.x(), y, encoder_place_.z()}}};
}

}  // namespace scree
