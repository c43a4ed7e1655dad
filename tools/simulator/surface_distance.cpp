#include "simulator/surface_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace scree {
namespace {

using Eigen::Vector3d;

double distance_to_edge(const Vector3d& point, const Vector3d& a, const Vector3d& b) {
  const double along = std::clamp((point - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (point - a - along * (b - a)).norm();
}

/// @pre seen from above the triangle has an area
double distance_to_triangle(const Vector3d& point, const std::array<Vector3d, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vector3d normal = (b - a).cross(c - a);
  const auto is_inside = [&](const Vector3d& from, const Vector3d& to) {
    return (to - from).cross(point - from).dot(normal) >= 0;
  };
  if (is_inside(a, b) && is_inside(b, c) && is_inside(c, a)) {
    return std::abs((point - a).dot(normal)) / normal.norm();
  }
  return std::min({distance_to_edge(point, a, b), distance_to_edge(point, b, c),
                   distance_to_edge(point, c, a)});
}

double distance_to_cell(const Terrain& terrain, std::ptrdiff_t column, std::ptrdiff_t row,
                        const Vector3d& point) {
  const auto last = static_cast<std::ptrdiff_t>(terrain.vertices()) - 1;
  if (column < 0 || row < 0 || column >= last || row >= last) {
    return std::numeric_limits<double>::infinity();
  }
  const auto corner = [&](std::ptrdiff_t right, std::ptrdiff_t up) {
    const auto u = static_cast<std::size_t>(column + right);
    const auto v = static_cast<std::size_t>(row + up);
    return Vector3d(terrain.coordinate(u), terrain.coordinate(v),
                    static_cast<double>(terrain.vertex(u, v)));
  };
  const Vector3d a = corner(0, 0);
  const Vector3d b = corner(1, 0);
  const Vector3d c = corner(1, 1);
  const Vector3d d = corner(0, 1);
  return std::min(distance_to_triangle(point, {a, b, c}), distance_to_triangle(point, {a, c, d}));
}

/// Whether grass, a plant or the like is so near that a voxel or a pose that is a little off may
/// have put a leaf of it here.
bool is_near_volume(const Terrain& terrain, const Vector3d& point) {
  constexpr double kMargin = 0.1;  // metres
  return terrain.volumes().is_near(point.x(), point.y(), kMargin);
}

}  // namespace

double distance_to_surface(const Terrain& terrain, const Vector3d& point) {
  const double cell = terrain.settings().cell;
  const auto cell_of = [&](double at) {
    return static_cast<std::ptrdiff_t>(std::floor((at + terrain.half_size()) / cell));
  };
  const std::ptrdiff_t column = cell_of(point.x());
  const std::ptrdiff_t row = cell_of(point.y());
  double least = std::abs(terrain.clearance(point));
  // Rings of cells about the point's own; a ring is at least as far away as those inside are wide.
  for (std::ptrdiff_t ring = 0; static_cast<double>(ring - 1) * cell < least; ++ring) {
    for (std::ptrdiff_t v = -ring; v <= ring; ++v) {
      const std::ptrdiff_t step = std::abs(v) == ring ? 1 : 2 * ring;
      for (std::ptrdiff_t u = -ring; u <= ring; u += step) {
        least = std::min(least, distance_to_cell(terrain, column + u, row + v, point));
      }
    }
  }
  return least;
}

double SurfaceError::rms() const {
  return points == 0 ? std::numeric_limits<double>::quiet_NaN()
                     : std::sqrt(squares / static_cast<double>(points));
}

SurfaceError& SurfaceError::operator+=(const SurfaceError& other) {
  points += other.points;
  near_volumes += other.near_volumes;
  squares += other.squares;
  return *this;
}

SurfaceError surface_error(const Terrain& terrain, PointView cloud, const Pose& to_world) {
  SurfaceError error;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3d point =
        to_world * Eigen::Vector3f(cloud.x[i], cloud.y[i], cloud.z[i]).cast<double>();
    if (!terrain.covers(point.x(), point.y())) continue;
    if (is_near_volume(terrain, point)) {
      ++error.near_volumes;
      continue;
    }
    const double distance = distance_to_surface(terrain, point);
    ++error.points;
    error.squares += distance * distance;
  }
  return error;
}

}  // namespace scree
