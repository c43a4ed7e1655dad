#include "simulator/placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "simulator/curves.hpp"

namespace scree {

FreeGround::FreeGround(const Terrain& terrain) : terrain_(terrain) {
  for (const TerrainFeature& feature : terrain.features()) {
    if (feature.kind) take(feature.footprint);
  }
}

void FreeGround::take(const Footprint& footprint) {
  Taken taken{footprint, Eigen::Vector2d::Zero(), 0};
  for (const Eigen::Vector2d& corner : footprint) taken.center += corner;
  taken.center /= static_cast<double>(std::max<std::size_t>(footprint.size(), 1));
  for (const Eigen::Vector2d& corner : footprint) {
    taken.reach = std::max(taken.reach, (corner - taken.center).norm());
  }
  taken_.push_back(std::move(taken));
}

bool FreeGround::has_room(const Footprint& footprint, double gap) const {
  const TerrainSettings& settings = terrain_.settings();
  const double most = terrain_.half_size() - 0.5;
  for (const Eigen::Vector2d& corner : footprint) {
    if (corner.cwiseAbs().maxCoeff() > most) return false;
  }
  for (const Eigen::Vector2d& by : settings.corridor) {
    if (distance(footprint, by) < settings.corridor_half_width) return false;
  }
  if (settings.clear_radius > 0 &&
      distance(footprint, Eigen::Vector2d(0, 0)) < settings.clear_radius) {
    return false;
  }
  return std::ranges::none_of(taken_, [&](const Taken& taken) {
    return distance(footprint, taken.center) < taken.reach + gap &&
           distance(footprint, taken.footprint) < gap;
  });
}

Eigen::Vector2d FreeGround::anywhere(Random& random) const {
  const double half = terrain_.half_size();
  const double x = random.uniform(-half, half);
  return {x, random.uniform(-half, half)};
}

Eigen::Vector2d FreeGround::near_way(double within, Random& random) const {
  const auto& way = terrain_.settings().corridor;
  if (way.empty()) {
    const double x = random.uniform(-within, within);
    return {x, random.uniform(-within, within)};
  }
  const Eigen::Vector2d& by = way[random.index(way.size())];
  const double angle = random.uniform(0, 2 * std::numbers::pi);
  return by + random.uniform(0, within) * unit_vector(angle);
}

double FreeGround::from_way(const Eigen::Vector2d& place) const {
  const TerrainSettings& settings = terrain_.settings();
  if (settings.corridor.empty()) return std::max(place.norm() - settings.clear_radius, 0.0);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& by : settings.corridor) {
    nearest = std::min(nearest, (by - place).norm());
  }
  return nearest;
}

double FreeGround::way_beside(const Eigen::Vector2d& place, Random& random) const {
  const auto& way = terrain_.settings().corridor;
  const double any = random.uniform(-std::numbers::pi, std::numbers::pi);
  if (way.size() < 4) return any;
  const auto nearest = std::ranges::min_element(
      way, {}, [&](const Eigen::Vector2d& by) { return (by - place).squaredNorm(); });
  const auto i = std::clamp<std::ptrdiff_t>(nearest - way.begin(), 1,
                                            static_cast<std::ptrdiff_t>(way.size()) - 2);
  const Eigen::Vector2d along =
      way[static_cast<std::size_t>(i + 1)] - way[static_cast<std::size_t>(i - 1)];
  return std::atan2(along.y(), along.x());
}

}  // namespace scree
