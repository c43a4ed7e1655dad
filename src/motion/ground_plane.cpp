#include "scree/motion/ground_plane.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace scree {
namespace {

/// z = plane . (x, y, 1)
using Plane = Eigen::Vector3d;

/// A weighted least-squares fit of a plane, point by point.
class PlaneFit {
public:
  void add(const Eigen::Vector3d& point, double weight) {
    const Eigen::Vector3d at(point.x(), point.y(), 1);
    information_ += weight * at * at.transpose();
    gradient_ += weight * point.z() * at;
  }
  Plane plane() const { return information_.ldlt().solve(gradient_); }

private:
  // Where the points lie in a line it is level across it.
  Eigen::Matrix3d information_ = Eigen::Vector3d(0.01, 0.01, 1e-6).asDiagonal();
  Eigen::Vector3d gradient_ = Eigen::Vector3d::Zero();
};

double distance(const Plane& plane, const Eigen::Vector3d& point) {
  return point.z() - plane.dot(Eigen::Vector3d(point.x(), point.y(), 1));
}

double cauchy_weight(double distance, double scale) {
  return 1 / (1 + distance * distance / (scale * scale));
}

GroundPlane seen_from_origin(const Plane& plane) {
  const double length = std::sqrt(1 + plane.head<2>().squaredNorm());
  return {Eigen::Vector3d(-plane.x(), -plane.y(), 1) / length, -plane.z() / length};
}

}  // namespace

std::optional<GroundPlane> fit_ground_around(const PointCloud& points) {
  constexpr double kReach = 6.5;        // metres
  constexpr double kLeastBelow = 0.15;  // metres: nothing lower hangs over the robot's ground
  constexpr std::size_t kEvery = 5;     // point is enough
  constexpr std::size_t kLeast = 150;   // points
  constexpr double kFirstScale = 0.5;   // metres, of what the first rounds take for ground ...
  constexpr double kLastScale = 0.08;   // ... and the last ones
  constexpr double kNarrower = 0.7;
  constexpr int kRounds = 12;
  // Few points lie deeper than this below the ground. Where many do, it is a plane through grass.
  constexpr double kDeep = 0.16, kMostDeep = 0.1;  // metres; share of the points
  Plane plane = Plane::Zero();
  double scale = kFirstScale;
  std::size_t count = 0, deep = 0;
  for (int round = 0; round < kRounds; ++round) {
    PlaneFit fit;
    count = deep = 0;
    for (std::size_t i = 0; i < points.size(); i += kEvery) {
      const Eigen::Vector3d point(points.x[i], points.y[i], points.z[i]);
      if (point.z() > -kLeastBelow || point.head<2>().norm() > kReach) continue;
      const double above = distance(plane, point);
      fit.add(point, round == 0 ? 1 : cauchy_weight(above, scale));
      deep += above < -kDeep ? 1 : 0;
      ++count;
    }
    if (count < kLeast) return std::nullopt;
    plane = fit.plane();
    scale = std::max(kLastScale, kNarrower * scale);
  }
  if (static_cast<double>(deep) > kMostDeep * static_cast<double>(count)) return std::nullopt;
  return seen_from_origin(plane);
}

GroundPlane fit_ground_below(const PointCloud& points, const Eigen::Vector3d& place) {
  constexpr double kScale = 0.05;  // metres: a stone among them
  constexpr int kRounds = 5;
  Plane plane = Plane::Zero();
  for (int round = 0; round < kRounds; ++round) {
    PlaneFit fit;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d point = Eigen::Vector3d(points.x[i], points.y[i], points.z[i]) - place;
      fit.add(point, round == 0 ? 1 : cauchy_weight(distance(plane, point), kScale));
    }
    plane = fit.plane();
  }
  return seen_from_origin(plane);
}

}  // namespace scree
