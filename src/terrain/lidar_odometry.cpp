#include "scree/terrain/lidar_odometry.hpp"

#include <cmath>
#include <utility>

namespace scree {
namespace {

constexpr double kOdometryReach = 10;     // metres
constexpr float kOdometrySurfel = 0.35F;  // edge, metres; 64 of them hold the reach on both sides

}  // namespace

LidarOdometry::LidarOdometry(std::size_t max_points, OwnReturns own)
    : own_(std::move(own)),
      sweep_(max_points),
      registration_(max_points),
      surfels_(kOdometrySurfel, 64, 32) {
  lidar_.max_range = kOdometryReach;
}

bool LidarOdometry::add(const Sweep& sweep) {
  constexpr std::int64_t kLongest = 500'000'000;
  const std::int64_t since_ns = sweep.end_ns - end_ns_;
  const bool goes_on = end_ns_ != 0 && since_ns > 0 && since_ns <= kLongest;
  if (!goes_on) {
    filter_ = {};
    surfels_.clear();
  }
  begin_ns_ = end_ns_;
  end_ns_ = sweep.end_ns;
  const Pose before = filter_.pose();
  const double seconds = goes_on ? static_cast<double>(since_ns) * 1e-9 : 0.1;
  if (goes_on) filter_.predict(seconds);
  filter_.write(trajectory_, seconds);
  deskew(sweep, lidar_, trajectory_, own_, sweep_);
  own_.end_sweep(0);
  outcome_ = registration_.align(sweep_, surfels_, filter_);
  add_surfels();
  step_ = before.inverse() * filter_.pose();
  return goes_on;
}

bool LidarOdometry::is_bound() const {
  // A velocity that is bound every 0.1 s is known to 0.2 m/s, by the walk that the filter allows.
  // On simulated drives the steps within these limits are right to 0.1 m/s but for a few.
  constexpr double kDeviation = 0.33, kPer = 0.1;  // m/s, after a step of so many seconds
  constexpr int kLeastKeyPoints = 700;
  const double seconds = static_cast<double>(end_ns_ - begin_ns_) * 1e-9;
  const double most = kDeviation * std::sqrt(seconds / kPer);
  return outcome_.key_points >= kLeastKeyPoints &&
         filter_.speed_deviation(Eigen::Vector3d::UnitX()) < most &&
         filter_.speed_deviation(Eigen::Vector3d::UnitY()) < most;
}

void LidarOdometry::add_surfels() {
  for (std::size_t i = 0; i < sweep_.points.size(); ++i) {
    const Eigen::Vector3d point(sweep_.points.x[i], sweep_.points.y[i], sweep_.points.z[i]);
    surfels_.add(filter_.place(point, -1e-9 * sweep_.time_ns[i]).cast<float>());
  }
}

Eigen::Vector3d LidarOdometry::above_middle(const Pose& lidar_mount) {
  return lidar_mount.rotation.conjugate() *
         Eigen::Vector3d(-lidar_mount.translation.x(), -lidar_mount.translation.y(), 0);
}

std::optional<GroundPlane> LidarOdometry::ground_below(const Eigen::Vector3d& place) {
  constexpr double kHalfWidth = 0.4, kApart = 0.2;  // metres: the robot's, where no rocks are
  constexpr double kDeepest = 2.5;                  // metres
  constexpr float kLeastUp = 0.8F;                  // of a normal's z
  constexpr std::size_t kLeast = 12;                // of 25
  const Pose& pose = filter_.pose();
  ground_.clear();
  for (double x = -kHalfWidth; x <= kHalfWidth; x += kApart) {
    for (double y = -kHalfWidth; y <= kHalfWidth; y += kApart) {
      for (double z = 0.1; z < kDeepest; z += kOdometrySurfel / 2) {
        const Eigen::Vector3d at = pose * (place + Eigen::Vector3d(x, y, -z));
        const Surfel* const surfel = surfels_.at(at.cast<float>());
        if (surfel == nullptr || surfel->normal.z() < kLeastUp) continue;
        const Eigen::Vector3f center =
            (pose.rotation.conjugate() * (surfel->center.cast<double>() - pose.translation))
                .cast<float>();
        ground_.push_back(center.x(), center.y(), center.z(), 0);
        break;
      }
    }
  }
  if (ground_.size() < kLeast) return std::nullopt;
  return fit_ground_below(ground_, place);
}

}  // namespace scree
