#include "calibration_estimator.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "robust_fit.hpp"
#include "scree/core/pose.hpp"
#include "setup_angles.hpp"

namespace scree {
namespace {

using Values = CalibrationEstimator::Values;

constexpr double kNotShown = std::numeric_limits<double>::quiet_NaN();
constexpr double kWorst = std::numeric_limits<double>::infinity();
constexpr double kLeastTurns = 0.1;  // rad^2, of all windows

double& at(Values& values, Calibrated which) {
  return values[static_cast<std::size_t>(which)];
}

/// By three angles, of which the roll is the first.
Eigen::Matrix3d rotation_of(const Values& values, Calibrated roll) {
  const auto first = static_cast<std::size_t>(roll);
  return from_roll_pitch_yaw(radians(values[first]), radians(values[first + 1]),
                             radians(values[first + 2]))
      .toRotationMatrix();
}

double median_size(const Eigen::VectorXd& values) {
  std::vector<double> sizes(values.begin(), values.end());
  for (double& size : sizes) size = std::abs(size);
  return median(sizes);
}

/// The shift of a time, seconds, with the least cost; between steps by a parabola. Not shown where
/// it lies at an end.
template <class Cost>
double best_shift(const Cost& cost) {
  constexpr int kEachWay = 16;
  constexpr double kStep = 0.005;  // seconds
  std::array<double, 2 * kEachWay + 1> costs{};
  for (std::size_t i = 0; i < costs.size(); ++i) {
    costs[i] = cost((static_cast<double>(i) - kEachWay) * kStep);
  }
  const auto least = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
  if (least == 0 || least + 1 == costs.size()) return kNotShown;
  const double before = costs[least - 1], after = costs[least + 1];
  const double bend = before + after - 2 * costs[least];
  const double beside = bend > 0 ? (before - after) / (2 * bend) : 0;
  return (static_cast<double>(least) - kEachWay + beside) * kStep;
}

Eigen::Matrix3d lidar_rotation(const Eigen::Vector3d& ahead, const Eigen::Vector3d& up) {
  Eigen::Matrix3d axes;  // of `base`, in `lidar`
  axes.col(0) = ahead.normalized();
  axes.col(1) = up.cross(ahead).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes.transpose();
}

/// In `lidar`, from what is driven straight; nothing where that is too little.
std::optional<Eigen::Vector3d> direction_of_travel(const std::vector<DriveWindow>& windows,
                                                   const Eigen::Matrix3d& rotation,
                                                   const Eigen::Vector3d& arm) {
  constexpr double kMostRate = 0.25, kLeastSpeed = 0.2;  // rad/s, m/s
  Eigen::Matrix3Xd ways(3, windows.size());
  Eigen::Index count = 0;
  for (const DriveWindow& each : windows) {
    const Eigen::Vector3d turn = rotation * each.turn;
    const Eigen::Vector3d way = rotation * each.way - turn.cross(arm);
    if (std::abs(turn.z()) > kMostRate * each.seconds()) continue;
    if (way.norm() < kLeastSpeed * each.seconds()) continue;
    ways.col(count++) = rotation.transpose() * (way.x() < 0 ? -way : way);
  }
  if (count < static_cast<Eigen::Index>(CalibrationEstimator::kLeastWindows) / 2)
    return std::nullopt;
  return robust_direction(ways.leftCols(count));
}

/// How far ahead of the middle the lidar is: so far it swings sideways when the robot turns.
double arm_ahead(const std::vector<DriveWindow>& windows, const Eigen::Matrix3d& rotation) {
  Eigen::MatrixXd turns(windows.size(), 1);
  Eigen::VectorXd aside(windows.size());
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    turns(row, 0) = (rotation * windows[i].turn).z();
    aside(row) = (rotation * windows[i].way).y();
  }
  return turns.squaredNorm() < kLeastTurns ? kNotShown : robust_fit(turns, aside)(0);
}

/// Turns about one axis leave open how the IMU lies about it.
bool turns_about_two_axes(const Eigen::Matrix3Xd& turns) {
  constexpr double kLeast = 0.002;  // rad, root mean square
  const Eigen::Matrix3d squares = turns * turns.transpose() / static_cast<double>(turns.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(squares, Eigen::EigenvaluesOnly);
  return axes.eigenvalues()(1) > kLeast * kLeast;
}

}  // namespace

CalibrationEstimator::CalibrationEstimator(const DriveRecord& drive, const Settings& set)
    : drive_(drive), set_(set), windows_(windows_of(drive)) {
  for (const LidarStep& step : drive.steps) {
    if (step.is_bound && step.below) ground_.push_back({step.end_ns, *step.below});
  }
}

CalibrationEstimator::Values CalibrationEstimator::estimate(
    std::optional<std::size_t> without) const {
  const auto part_of = [&](std::int64_t t_ns) {
    const std::int64_t begin = windows_.front().begin_ns;
    const std::int64_t all = windows_.back().end_ns - begin + 1;
    const std::int64_t part = (t_ns - begin) * static_cast<std::int64_t>(kParts) / all;
    return static_cast<std::size_t>(std::clamp<std::int64_t>(part, 0, kParts - 1));
  };
  Windows windows;
  std::vector<Ground> ground;
  for (const DriveWindow& each : windows_) {
    if (part_of(each.begin_ns) != without) windows.push_back(each);
  }
  for (const Ground& each : ground_) {
    if (part_of(each.t_ns) != without) ground.push_back(each);
  }
  Values values;
  values.fill(kNotShown);
  if (windows.empty() || ground.empty()) return values;
  estimate_lidar(windows, ground, values);
  if (std::isnan(at(values, Calibrated::lidar_roll))) return values;
  estimate_imu(windows, values);
  estimate_wheel(windows, values);
  return values;
}

void CalibrationEstimator::estimate_lidar(const Windows& windows, const std::vector<Ground>& ground,
                                          Values& values) const {
  std::array<std::vector<double>, 3> normals;
  std::vector<double> heights;
  for (const Ground& each : ground) {
    for (std::size_t i = 0; i < 3; ++i) {
      normals[i].push_back(each.plane.normal(static_cast<Eigen::Index>(i)));
    }
    heights.push_back(each.plane.height);
  }
  const Eigen::Vector3d up(median(normals[0]), median(normals[1]), median(normals[2]));
  const double height = median(heights);
  Eigen::Matrix3d rotation = set_.lidar.mount().rotation.toRotationMatrix();
  Eigen::Vector3d arm(set_.lidar.translation.x(), set_.lidar.translation.y(), height);
  double x = kNotShown;
  constexpr int kTwice = 2;  // the arm changes the direction a little, and the other way round
  for (int round = 0; round < kTwice; ++round) {
    const auto ahead = direction_of_travel(windows, rotation, arm);
    if (!ahead) return;
    rotation = lidar_rotation(*ahead, up);
    x = arm_ahead(windows, rotation);
    if (!std::isnan(x)) arm.x() = x;
  }
  const Eigen::Vector3d rpy = roll_pitch_yaw_deg(rotation);
  at(values, Calibrated::lidar_roll) = rpy.x();
  at(values, Calibrated::lidar_pitch) = rpy.y();
  at(values, Calibrated::lidar_yaw) = rpy.z();
  at(values, Calibrated::lidar_x) = x;
  at(values, Calibrated::lidar_height) = height;
}

void CalibrationEstimator::estimate_imu(const Windows& windows, Values& values) const {
  const Eigen::Matrix3d lidar = rotation_of(values, Calibrated::lidar_roll);
  double delay = 0;
  Eigen::Matrix3d rotation;
  constexpr int kTwice = 2;  // a delay blurs the rotation, and the other way round
  for (int round = 0; round < kTwice; ++round) {
    const auto [by_lidar, by_imu] = turns_of(windows, delay);
    if (by_lidar.cols() < static_cast<Eigen::Index>(kLeastWindows)) return;
    if (!turns_about_two_axes(by_lidar)) return;
    rotation = robust_rotation(by_imu, by_lidar);
    delay = best_shift([&](double shift) {
      const auto [lidar_turns, imu_turns] = turns_of(windows, shift);
      if (lidar_turns.cols() == 0) return kWorst;
      return median_size((lidar_turns - rotation * imu_turns).colwise().norm());
    });
    if (std::isnan(delay)) break;
  }
  at(values, Calibrated::imu_delay) = set_.imu.delay + delay;
  const Eigen::Vector3d rpy = roll_pitch_yaw_deg(lidar * rotation);
  at(values, Calibrated::imu_roll) = rpy.x();
  at(values, Calibrated::imu_pitch) = rpy.y();
  at(values, Calibrated::imu_yaw) = rpy.z();
}

std::pair<Eigen::Matrix3Xd, Eigen::Matrix3Xd> CalibrationEstimator::turns_of(const Windows& windows,
                                                                             double delay) const {
  const auto delay_ns = static_cast<std::int64_t>(delay * 1e9);
  Eigen::Matrix3Xd by_lidar(3, windows.size()), by_imu(3, windows.size());
  Eigen::Index count = 0;
  for (const DriveWindow& each : windows) {
    const auto turn = imu_turn(drive_, each.begin_ns + delay_ns, each.end_ns + delay_ns);
    if (!turn) continue;
    by_lidar.col(count) = each.turn;
    by_imu.col(count++) = *turn;
  }
  return {by_lidar.leftCols(count), by_imu.leftCols(count)};
}

/// What the robot moved in each window, and how far the wheel rolled.
struct CalibrationEstimator::Rolled {
  Eigen::MatrixX2d moved;  // metres ahead, radians to the left
  Eigen::VectorXd way;     // metres
};

/// @param delay of the wheel's times, seconds
CalibrationEstimator::Rolled CalibrationEstimator::rolled(const Windows& windows,
                                                          const Eigen::Matrix3d& lidar,
                                                          const Eigen::Vector3d& arm,
                                                          double delay) const {
  const auto delay_ns = static_cast<std::int64_t>(delay * 1e9);
  const auto most = static_cast<Eigen::Index>(windows.size());
  Rolled rolled{Eigen::MatrixX2d(most, 2), Eigen::VectorXd(most)};
  Eigen::Index count = 0;
  for (const DriveWindow& each : windows) {
    const auto way = wheel_way(drive_, each.begin_ns + delay_ns, each.end_ns + delay_ns);
    if (!way) continue;
    const Eigen::Vector3d turn = lidar * each.turn;
    const Eigen::Vector3d base = lidar * each.way - turn.cross(arm);
    rolled.moved.row(count) << std::copysign(base.norm(), base.x()), turn.z();
    rolled.way(count++) = *way;
  }
  rolled.moved.conservativeResize(count, Eigen::NoChange);
  rolled.way.conservativeResize(count);
  return rolled;
}

void CalibrationEstimator::estimate_wheel(const Windows& windows, Values& values) const {
  constexpr double kLeastWay = 4;  // metres
  const Eigen::Matrix3d lidar = rotation_of(values, Calibrated::lidar_roll);
  const double x = at(values, Calibrated::lidar_x);
  const Eigen::Vector3d arm(std::isnan(x) ? set_.lidar.translation.x() : x,
                            set_.lidar.translation.y(), at(values, Calibrated::lidar_height));
  const Rolled all = rolled(windows, lidar, arm, 0);
  if (all.way.size() < static_cast<Eigen::Index>(kLeastWindows)) return;
  if (all.moved.col(0).cwiseAbs().sum() < kLeastWay) return;
  const bool has_turns = all.moved.col(1).squaredNorm() >= kLeastTurns;
  const Eigen::Index columns = has_turns ? 2 : 1;
  const Eigen::VectorXd factors = robust_fit(all.moved.leftCols(columns), all.way);
  at(values, Calibrated::encoder_scale) = set_.encoder.scale / factors(0);
  if (has_turns) at(values, Calibrated::encoder_y) = -factors(1) / factors(0);
  at(values, Calibrated::encoder_delay) =
      set_.encoder.delay + best_shift([&](double shift) {
        const Rolled shifted = rolled(windows, lidar, arm, shift);
        if (shifted.way.size() == 0) return kWorst;
        return median_size(shifted.way - shifted.moved.leftCols(columns) * factors);
      });
}

}  // namespace scree
