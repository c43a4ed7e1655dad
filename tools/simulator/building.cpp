#include "simulator/building.hpp"

#include <numbers>

namespace scree {

Footprint rectangle(const Eigen::Vector2d& center, const Eigen::Vector2d& half, double yaw) {
  const Eigen::Vector2d along = half.x() * unit_vector(yaw);
  const Eigen::Vector2d across = half.y() * unit_vector(yaw + kTurn / 4);
  return {center + along + across, center - along + across, center - along - across,
          center + along - across};
}

void Building::add(TerrainThing& thing, Volume volume, std::uint16_t part, double brightness) {
  volume.part = part;
  volume.darkest = brightness - 5;
  volume.brightest = brightness + 5;
  thing.volumes.push_back(volume);
}

void Building::finish(TerrainThing& thing, std::string_view name, const Eigen::Vector2d& at,
                      double height, std::optional<Line> line) {
  thing.feature.name = name;
  thing.feature.kind = ObstacleKind::positive;
  thing.feature.height = height;
  thing.feature.center = above(at, height / 2);
  if (!line) {
    thing.places = {at};
    return;
  }
  const double parts = std::max(std::floor(line->length / kPart), 1.0);
  for (double i = 0; i < parts; ++i) {
    thing.places.push_back(line->at(((i + 0.5) / parts - 0.5) * line->length));
  }
}

Building::Line Building::line_beside_way(double shortest, double longest) {
  const Eigen::Vector2d middle = near_way();
  const double yaw = ground_.way_beside(middle, random_) + random_.uniform(-0.4, 0.4);
  return {middle, yaw, random_.uniform(shortest, longest)};
}

/// Along one side of all of the way.
Building::Line Building::line_beyond_way(double shortest, double longest) {
  const double away = random_.uniform(0, kTurn);
  const auto& way = terrain_.settings().corridor;
  Eigen::Vector2d middle(0, 0);
  double most = 0;
  for (const Eigen::Vector2d& by : way) {
    middle += by / static_cast<double>(way.size());
    most = std::max(most, by.dot(unit_vector(away)));
  }
  const double off = way.empty() ? random_.uniform(0.2, 0.7) * terrain_.settings().placed_within
                                 : random_.uniform(2, 7);
  middle += (most + off - middle.dot(unit_vector(away))) * unit_vector(away);
  // Its left side looks away from the way.
  return {middle, away - std::numbers::pi / 2, random_.uniform(shortest, longest)};
}

void Building::add_wall(TerrainThing& thing, const Line& line, double from, double to,
                        double recess, double height) {
  constexpr double kThick = 0.3;
  const double middle = (from + to) / 2;
  const Eigen::Vector2d at = line.at(middle) + line.aside(recess + kThick / 2);
  const double tall = (height + kSunk) / 2;
  const Volume wall =
      Volume::block(above(at, tall - kSunk), {(to - from) / 2, kThick / 2, tall}, line.yaw);
  add(thing, wall, line.part(middle), random_.uniform(25, 60));
}

void Building::add_window(TerrainThing& thing, const Line& line, double along, double recess,
                          double up) {
  constexpr double kProud = 0.01;
  const Eigen::Vector2d at = line.at(along) + line.aside(recess);
  Volume window = Volume::block(
      above(at, up), {random_.uniform(0.3, 0.8), kProud, random_.uniform(0.4, 0.8)}, line.yaw);
  window.is_dark = true;
  window.part = line.part(along);
  thing.volumes.push_back(window);
}

TerrainThing Building::facade() {
  TerrainThing facade;
  const Line line = line_beyond_way(8, 35);
  const double height = random_.uniform(2.5, 8);
  const bool has_windows = random_.chance(0.7);
  double deepest = 0;
  for (double along = -line.length / 2; along < line.length / 2 - 0.5;) {
    // Pieces no longer than a part, so that each belongs to the part that it is.
    const double end = std::min(along + random_.uniform(0.8, 1.2), line.length / 2);
    const double recess = random_.chance(0.25) ? random_.uniform(0.05, 0.4) : 0;
    deepest = std::max(deepest, recess);
    add_wall(facade, line, along, end, recess, height);
    if (has_windows && random_.chance(0.4)) {
      add_window(facade, line, (along + end) / 2, recess, random_.uniform(1.2, 1.7));
      if (height > 4.5) add_window(facade, line, (along + end) / 2, recess, 3.8);
    }
    along = end;
  }
  const double thick = deepest + 0.3;
  const Eigen::Vector2d middle = line.middle + line.aside(thick / 2);
  facade.feature.footprint = rectangle(middle, {line.length / 2, thick / 2}, line.yaw);
  finish(facade, has_windows ? "facade" : "wall", middle, height, line);
  return facade;
}

TerrainThing Building::fence() {
  TerrainThing fence;
  const Line line = line_beside_way(3, 14);
  const double height = random_.uniform(0.8, 1.8);
  const bool is_mesh = random_.chance(0.5);
  const double apart = random_.uniform(1.5, 3);
  const double brightness = random_.uniform(20, 60);
  const double thickness = random_.uniform(0.025, 0.06);
  const double half = line.length / 2;
  for (double along = -half; along <= half; along += apart) {
    const Eigen::Vector2d at = line.at(along);
    add(fence, Volume::rod(above(at, -kSunk), above(at, height), thickness), line.part(along),
        brightness);
  }
  const int rails = is_mesh ? 1 : 2 + static_cast<int>(random_.index(3));
  for (double along = -half; along < half; along += kPart) {
    const double end = std::min(along + kPart, half);
    const Eigen::Vector2d from = line.at(along), to = line.at(end);
    const std::uint16_t part = line.part((along + end) / 2);
    for (int i = 0; i < rails; ++i) {
      const double up = 0.97 * height * (rails - i) / rails;
      add(fence, Volume::rod(above(from, up), above(to, up), 0.7 * thickness), part, brightness);
    }
    if (!is_mesh) continue;
    constexpr double kThin = 0.02;
    Volume mesh = Volume::block(above((from + to) / 2, height / 2),
                                {(end - along) / 2, kThin / 2, height / 2}, line.yaw);
    mesh.density = -std::log(random_.uniform(0.6, 0.9)) / kThin;
    add(fence, mesh, part, brightness);
  }
  fence.feature.footprint = rectangle(line.middle, {half, 0.15}, line.yaw);
  finish(fence, "fence", line.middle, height, line);
  return fence;
}

}  // namespace scree
