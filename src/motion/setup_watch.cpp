#include "scree/motion/setup_watch.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "robust_fit.hpp"
#include "scree/core/pose.hpp"
#include "setup_angles.hpp"

namespace scree {
namespace {

// On 60 simulated right drives through all scenes the means over 2.5 s stay within 2.6 degrees of
// yaw and 3.9 of pitch by the travel, and within 0.13 m of height, 5 degrees of roll and 6 of pitch
// by the ground below. By the ground around, which is rough and slopes, 11 degrees and 0.38 m.
constexpr double kYaw = 5, kRightYaw = 3.5;      // degrees
constexpr double kPitch = 3, kRightPitch = 2.5;  // degrees, ...
constexpr double kPitchNoise = 5;                // ... and for a window alone so many more
constexpr double kRoll = 8, kTilt = 30;          // degrees, by the ground below and around
constexpr double kHeight = 0.25, kRightHeight = 0.15, kHeightAround = 0.5;  // metres
constexpr double kGraveTurn = 4.4, kGraveHeight = 0.35;                     // degrees; metres
constexpr int kTravelWindows = 5, kBelowWindows = 3, kAroundWindows = 5;
constexpr double kLeastTravel = 1;   // metres
constexpr double kLeastAlike = 0.7;  // of the windows: a mount is askew by the same angle always

}  // namespace

bool turn_alike(const Eigen::Vector3d& lidar, const Eigen::Vector3d& imu) {
  constexpr double kNoise = 0.015, kShare = 0.15;  // rad
  const double turned = lidar.norm(), imu_turned = imu.norm();
  return std::abs(turned - imu_turned) <= kNoise + kShare * std::max(turned, imu_turned);
}

SetupWatch::SetupWatch(const Settings& settings)
    : lidar_mount_(settings.lidar.mount()),
      lidar_(lidar_mount_.rotation.toRotationMatrix()),
      imu_(settings.imu.mount().rotation.toRotationMatrix()),
      encoder_scale_(settings.encoder.scale),
      encoder_place_(settings.encoder.translation),
      imu_delay_(settings.imu.delay),
      encoder_delay_(settings.encoder.delay),
      quarter_turns_(all_quarter_turns()) {
  belief(SetupFault::lidar_unset).is_named =
      settings.lidar.translation.isZero() && settings.lidar.rpy_deg.isZero();
  update_report();
}

void SetupWatch::Belief::update(const Verdict& verdict) {
  constexpr int kLeast = 2, kMost = 20, kForgiven = 4;
  switch (verdict.word) {
    case Word::unknown:
      return;
    case Word::right:
      wrongs_in_row = 0;
      rights = std::min(rights + 1, kMost);
      if (++rights_in_row >= kForgiven) is_named = false;
      return;
    case Word::wrong:
      rights_in_row = 0;
      ++wrongs_in_row;
      if (wrongs_in_row >= std::max(kLeast, rights)) is_named = true;
      if (is_named) {
        finding = verdict.finding;
        rights = 0;
      }
  }
}

SetupWatch::Seen SetupWatch::seen_in_base(const SetupWindow& window) const {
  Seen seen;
  seen.seconds = window.seconds;
  seen.is_bound = window.is_bound;
  seen.binds = window.binds;
  seen.turn = lidar_ * window.turn;
  // At a height that is far from the set one the lidar swings as far as it really does.
  Eigen::Vector3d arm = lidar_mount_.translation;
  if (window.around && std::abs(window.around->height - arm.z()) > kHeightAround) {
    arm.z() = window.around->height;
  }
  seen.way = lidar_ * window.way - seen.turn.cross(arm);
  const auto in_base = [this](std::optional<GroundPlane> ground) {
    if (ground) ground->normal = lidar_ * ground->normal;
    return ground;
  };
  seen.around = in_base(window.around);
  seen.below = in_base(window.below);
  seen.has_imu = window.has_imu;
  seen.imu_turn = imu_ * window.imu_turn;
  seen.imu_turn_gain = seen.imu_turn - imu_ * window.imu_turn_before;
  seen.imu_up = imu_ * window.imu_up;
  seen.has_force = window.has_force;
  seen.force = imu_ * window.imu_force;
  seen.has_wheel = window.has_wheel;
  seen.wheel = window.wheel;
  seen.wheel_gain = window.wheel - window.wheel_before;
  return seen;
}

void SetupWatch::add(const SetupWindow& window) {
  constexpr double kLeastSpeed = 0.15, kLeastRate = 0.15;  // m/s, rad/s: the robot moves
  Seen seen = seen_in_base(window);
  seen.long_turn = seen.turn;
  seen.long_imu_turn = seen.imu_turn;
  seen.long_turns = 1;
  if (before_ && before_->is_bound && seen.is_bound) {
    const double seconds = (before_->seconds + seen.seconds) / 2;
    seen.change = (seen.way / seen.seconds - before_->way / before_->seconds) / seconds;
    seen.mean_force = (before_->force + seen.force) / 2;
    seen.has_change = before_->has_force && seen.has_force;
    if (before_->long_turns < kLongTurns && before_->has_imu) {
      seen.long_turn += before_->long_turn;
      seen.long_imu_turn += before_->long_imu_turn;
      seen.long_turns += before_->long_turns;
    }
  }
  before_ = seen;
  if (seen.way.norm() < kLeastSpeed * seen.seconds &&
      std::abs(seen.turn.z()) < kLeastRate * seen.seconds) {
    return;
  }
  ring_[count_++ % kWindows] = seen;
  judge();
  update_report();
}

void SetupWatch::judge() {
  belief(SetupFault::lidar_height).update(judge_lidar_height());
  belief(SetupFault::lidar_rotation).update(judge_lidar_rotation());
  belief(SetupFault::imu_rotation).update(judge_imu_rotation());
  const WheelFit fit = fit_wheel();
  belief(SetupFault::encoder_scale).update(judge_encoder_scale(fit));
  belief(SetupFault::encoder_place).update(judge_encoder_place(fit));
  belief(SetupFault::imu_delay).update(judge_imu_delay());
  belief(SetupFault::encoder_delay).update(judge_encoder_delay(fit));
}

void SetupWatch::update_report() {
  report_.count = 0;
  for (const bool is_grave : {true, false}) {
    for (const Belief& belief : beliefs_) {
      if (!belief.is_named || belief.finding.is_grave != is_grave) continue;
      report_.findings[report_.count++] = belief.finding;
    }
  }
}

/// Where registration lost its way the directions differ from window to window; a lidar that is
/// mounted askew sees the same one always.
SetupWatch::Travel SetupWatch::travel() const {
  constexpr double kMostRate = 0.25, kLeastSpeed = 0.2;  // rad/s, m/s
  constexpr double kAlike = radians(6);
  std::array<Eigen::Vector3d, kWindows> ways;
  std::array<double, kWindows> yaws{};
  std::size_t count = 0;
  for (const Seen& seen : windows()) {
    if (!seen.is_bound || std::abs(seen.turn.z()) > kMostRate * seen.seconds) continue;
    if (seen.way.norm() < kLeastSpeed * seen.seconds) continue;
    ways[count] = seen.way.x() < 0 ? -seen.way : seen.way;
    yaws[count] = std::atan2(ways[count].y(), ways[count].x());
    ++count;
  }
  const double middle = median({yaws.data(), count});
  Travel travel;
  for (std::size_t i = 0; i < count; ++i) {
    if (std::abs(std::atan2(ways[i].y(), ways[i].x()) - middle) > kAlike) continue;
    travel.way += ways[i];
    ++travel.windows;
  }
  if (travel.windows < kLeastAlike * static_cast<double>(count)) return {};
  return travel;
}

SetupWatch::Ground SetupWatch::ground(std::optional<GroundPlane> Seen::*which) const {
  constexpr double kAlike = 4;  // degrees
  std::array<double, kWindows> heights{}, rolls{}, pitches{};
  std::size_t count = 0;
  for (const Seen& seen : windows()) {
    if (!(seen.*which)) continue;
    const Eigen::Vector3d& normal = (seen.*which)->normal;
    heights[count] = (seen.*which)->height;
    rolls[count] = degrees(std::atan2(normal.y(), normal.z()));
    pitches[count] = degrees(std::atan2(-normal.x(), normal.z()));
    ++count;
  }
  const auto middle_if_alike = [&](std::array<double, kWindows>& angles) {
    const double middle = median({angles.data(), count});
    const auto alike = std::count_if(angles.begin(), angles.begin() + count, [&](double angle) {
      return std::abs(angle - middle) < kAlike;
    });
    return static_cast<double>(alike) < kLeastAlike * static_cast<double>(count) ? 0 : middle;
  };
  return {median({heights.data(), count}), middle_if_alike(rolls), middle_if_alike(pitches),
          static_cast<int>(count)};
}

SetupWatch::Verdict SetupWatch::judge_lidar_height() const {
  const Ground below = ground(&Seen::below), around = ground(&Seen::around);
  const bool is_below = below.windows >= kBelowWindows;
  if (!is_below && around.windows < kAroundWindows) return {};
  const double height = is_below ? below.height : around.height;
  const double off = height - lidar_mount_.translation.z();
  if (std::abs(off) < (is_below ? kHeight : kHeightAround)) {
    return {is_below && std::abs(off) < kRightHeight ? Word::right : Word::unknown, {}};
  }
  const Eigen::Vector3d& is = lidar_mount_.translation;
  return {Word::wrong,
          {.fault = SetupFault::lidar_height,
           .is_grave = std::abs(off) > kGraveHeight,
           .off = off,
           .axis = Eigen::Vector3d::UnitZ(),
           .set = {is.x(), is.y(), height}}};
}

/// The robot travels along x of `base`, and stands upright on the ground below it.
SetupWatch::Verdict SetupWatch::judge_lidar_rotation() const {
  const Ground below = ground(&Seen::below), around = ground(&Seen::around);
  const Travel travelled = travel();
  double roll = 0, pitch = 0, yaw = 0;  // that the mount lacks, degrees
  bool is_right = false;
  if (travelled.windows >= kTravelWindows && travelled.way.norm() > kLeastTravel) {
    const Eigen::Vector3d& way = travelled.way;
    yaw = -degrees(std::atan2(way.y(), way.x()));
    pitch = degrees(std::atan2(way.z(), way.head<2>().norm()));
    is_right = std::abs(yaw) < kRightYaw && std::abs(pitch) < kRightPitch;
    if (std::abs(yaw) < kYaw) yaw = 0;
    if (std::abs(pitch) < kPitch + kPitchNoise / travelled.windows) pitch = 0;
  }
  if (below.windows >= kBelowWindows) {
    roll = below.roll;
  } else if (around.windows >= kAroundWindows && std::abs(around.roll) > kTilt) {
    roll = around.roll;
  }
  if (std::abs(roll) < kRoll) roll = 0;
  const bool has_travelled = travelled.windows >= kTravelWindows;
  if (!has_travelled && around.windows >= kAroundWindows && std::abs(around.pitch) > kTilt) {
    pitch = around.pitch;
  }
  if (roll == 0 && pitch == 0 && yaw == 0) return {is_right ? Word::right : Word::unknown, {}};
  const Eigen::AngleAxisd lacking(from_roll_pitch_yaw(radians(roll), radians(pitch), radians(yaw)));
  return {Word::wrong,
          {.fault = SetupFault::lidar_rotation,
           .is_grave = degrees(lacking.angle()) > kGraveTurn,
           .off = degrees(lacking.angle()),
           .axis = lacking.axis(),
           .set = roll_pitch_yaw_deg(lacking.toRotationMatrix() * lidar_)}};
}

}  // namespace scree
