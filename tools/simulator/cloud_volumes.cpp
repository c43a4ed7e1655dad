#include "simulator/cloud_volumes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {
namespace {

constexpr double kHighest = 8;     // metres above the ground: what a robot sees well
constexpr double kOverhead = 1.5;  // metres: below what hangs higher the ground is seen from aside

double surface_of(const Volume& volume) {
  const Eigen::Vector3d& half = volume.half;
  switch (volume.form) {
    case Volume::Form::box:
      return 8 * (half.x() * half.y() + half.y() * half.z() + half.z() * half.x());
    case Volume::Form::cylinder:
      return 4 * std::numbers::pi * half.x() * half.y();
    case Volume::Form::ellipsoid:
      break;
  }
  const double mean = std::cbrt(half.x() * half.y() * half.z());
  return 4 * std::numbers::pi * mean * mean;
}

Eigen::Vector3d direction(Random& random) {
  const double z = random.uniform(-1, 1);
  const double angle = random.uniform(0, 2 * std::numbers::pi);
  const double aside = std::sqrt(1 - z * z);
  return {aside * std::cos(angle), aside * std::sin(angle), z};
}

/// On the surface, in units of the half axes.
Eigen::Vector3d on_surface(const Volume& volume, Random& random) {
  if (volume.form == Volume::Form::ellipsoid) return direction(random);
  if (volume.form == Volume::Form::cylinder) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    return {random.uniform(-1, 1), std::cos(angle), std::sin(angle)};
  }
  const Eigen::Vector3d& half = volume.half;
  const Eigen::Vector3d faces(half.y() * half.z(), half.z() * half.x(), half.x() * half.y());
  double drawn = random.uniform(0, faces.sum());
  int axis = 0;
  while (axis < 2 && drawn >= faces[axis]) drawn -= faces[axis++];
  Eigen::Vector3d at{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  at[axis] = random.chance(0.5) ? 1 : -1;
  return at;
}

}  // namespace

VolumePoints::VolumePoints(const Terrain& terrain) : terrain_(terrain) {
  double sum = 0;
  for (const Volume& volume : terrain.volumes().all()) {
    if (volume.part == 0 || volume.is_dark) continue;
    const double mean = std::cbrt(volume.half.x() * volume.half.y() * volume.half.z());
    const double thick =
        volume.density == Volume::kSolid ? 1 : 1 - std::exp(-volume.density * mean);
    volumes_.push_back(&volume);
    area_.push_back(sum += thick * surface_of(volume));
  }
}

std::optional<Eigen::Vector3d> VolumePoints::draw(Random& random, double& reflectivity) const {
  const double drawn = random.uniform(0, area_.back());
  const auto found = std::upper_bound(area_.begin(), area_.end() - 1, drawn);
  const Volume& volume = *volumes_[static_cast<std::size_t>(found - area_.begin())];
  Eigen::Vector3d own = on_surface(volume, random);
  if (volume.density != Volume::kSolid) {
    // Light goes as deep as it does anywhere, seen from outside.
    const double across = 2 * volume.half.minCoeff();
    const double depth = -std::log(1 - random.uniform()) / volume.density;
    if (depth > across) return std::nullopt;
    own *= 1 - depth / across * 2 * random.uniform();
  }
  const Eigen::Vector3d at = volume.center + volume.axes * own.cwiseProduct(volume.half);
  reflectivity = random.uniform(volume.darkest, volume.brightest);
  const double up = terrain_.clearance(at);
  if (!terrain_.covers(at.x(), at.y()) || up < 0 || random.chance(up / kHighest)) {
    return std::nullopt;
  }
  return at;
}

double VolumePoints::light_at(double x, double y) const {
  double light = 1;
  const double ground = terrain_.height(x, y);
  terrain_.volumes().for_each_near(x, y, [&](const Volume& volume) {
    if (volume.part == 0) return;
    const Eigen::Vector3d reach = volume.reach();
    if (volume.center.z() - reach.z() > ground + kOverhead) return;
    const double away =
        std::hypot((x - volume.center.x()) / reach.x(), (y - volume.center.y()) / reach.y());
    if (away >= 1) return;
    if (volume.density == Volume::kSolid) {
      light = 0;
      return;
    }
    const double path = reach.z() * std::sqrt(1 - away * away) * 1.5;
    light *= std::exp(-volume.density * path);
  });
  return light;
}

}  // namespace scree
