#include "simulator/building.hpp"

namespace scree {

TerrainThing Building::car() {
  TerrainThing car;
  const Line line = line_beside_way(3.6, 4.8);
  const double width = random_.uniform(1.6, 1.9);
  const double brightness = random_.uniform(8, 70);
  constexpr double kBelow = 0.25, kWaist = 0.85, kRoof = 1.45, kGlass = 0.01;
  const auto box = [&](double along, double half_length, double half_width, double low,
                       double high) {
    const double up = (low + high) / 2;
    Eigen::Vector3d center = above(line.middle, up);
    center.head<2>() = line.at(along);
    return Volume::block(center, {half_length, half_width, (high - low) / 2}, line.yaw);
  };
  const double cabin = 0.26 * line.length;
  add(car, box(0, line.length / 2, width / 2, kBelow, kWaist), 1, brightness);
  add(car, box(-0.2, cabin, width / 2 - 0.12, kWaist, kRoof), 1, brightness);
  Volume glass = box(-0.2, cabin + kGlass, width / 2 - 0.12 + kGlass, kWaist + 0.08, kRoof - 0.1);
  glass.is_dark = true;
  car.volumes.push_back(glass);
  constexpr double kWheel = 0.31;
  for (const double along : {-0.3 * line.length, 0.3 * line.length}) {
    const Eigen::Vector2d across = line.aside(width / 2 - 0.02);
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector2d outside = line.at(along) + side * across;
      const Eigen::Vector2d inside = line.at(along) + 0.75 * side * across;
      add(car, Volume::rod(above(inside, kWheel), above(outside, kWheel), kWheel), 1, 8);
    }
  }
  car.feature.footprint = rectangle(line.middle, {line.length / 2, width / 2}, line.yaw);
  finish(car, "car", line.middle, kRoof);
  return car;
}

TerrainThing Building::pole() {
  TerrainThing pole;
  const Eigen::Vector2d at = near_way();
  const double height = random_.uniform(2.2, 7);
  const double radius = random_.uniform(0.03, 0.12);
  add(pole, Volume::rod(above(at, -kSunk), above(at, height), radius), 1, random_.uniform(20, 80));
  const double half = std::max(radius, 0.1);
  pole.feature.footprint = rectangle(at, {half, half}, 0);
  finish(pole, "pole", at, height);
  return pole;
}

TerrainThing Building::boom() {
  TerrainThing boom;
  const Line line = line_beside_way(1.2, 5);
  const double radius = random_.uniform(0.04, 0.16);
  const double up = random_.uniform(0.3, 1.2) + radius;
  const double half = line.length / 2;
  const double brightness = random_.uniform(20, 70);
  const bool is_table = random_.chance(0.25);
  const double width = is_table ? random_.uniform(0.3, 0.6) : radius;
  const Eigen::Vector3d from = above(line.at(-half), up), to = above(line.at(half), up);
  if (is_table) {
    Volume top = Volume::block((from + to) / 2, {half, width, 0.03}, line.yaw);
    add(boom, top, 1, brightness);
  } else {
    add(boom, Volume::rod(from, to, radius), 1, brightness);
  }
  const bool reaches_out = !is_table && random_.chance(0.4);  // held at one end only
  for (const double along : {-half, half}) {
    if (reaches_out && along > 0) continue;
    const double z = along < 0 ? from.z() : to.z();
    Eigen::Vector3d head = above(line.at(0.96 * along), 0);
    const Eigen::Vector3d foot = head - Eigen::Vector3d(0, 0, kSunk);
    head.z() = z;
    add(boom, Volume::rod(foot, head, random_.uniform(0.03, 0.06)), 1, brightness);
  }
  boom.feature.footprint = rectangle(line.middle, {half, std::max(width, 0.15)}, line.yaw);
  finish(boom, is_table ? "table" : "boom", line.middle, up + (is_table ? 0.03 : radius));
  return boom;
}

TerrainThing Building::debris() {
  constexpr double kLeastDebris = 0.15;  // metres: lower ones are not asked for
  TerrainThing debris;
  const Line line = line_beside_way(0.1, 0.5);
  const bool is_plank = random_.chance(0.4);
  const Eigen::Vector3d half =
      is_plank ? Eigen::Vector3d{random_.uniform(0.4, 1.3), random_.uniform(0.04, 0.12),
                                 random_.uniform(0.015, 0.05)}
               : Eigen::Vector3d{line.length / 2, random_.uniform(0.05, 0.25),
                                 random_.uniform(0.05, 0.2)};
  Volume box = Volume::block(above(line.middle, half.z()), half, random_.uniform(0, kTurn));
  const double yaw = std::atan2(box.axes(1, 0), box.axes(0, 0));
  add(debris, box, 1, random_.uniform(15, 70));
  debris.feature.footprint = rectangle(line.middle, half.head<2>(), yaw);
  debris.feature.is_small = 2 * half.z() < kLeastDebris;
  finish(debris, is_plank ? "plank" : "box", line.middle, 2 * half.z());
  return debris;
}

}  // namespace scree
