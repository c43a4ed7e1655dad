#include "simulator/structures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace scree {
namespace {

enum StructureStream : std::uint64_t { kFacades = 1000, kFences, kCars, kPoles, kBooms, kDebris };

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kSunk = 0.3;          // metres that a wall or post goes into the ground
constexpr double kLeastHeight = 0.15;  // metres: lower debris is not asked for
constexpr double kPart = 1;            // length of the parts of a long one, metres

Eigen::Vector2d unit(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

Footprint rectangle(const Eigen::Vector2d& center, const Eigen::Vector2d& half, double yaw) {
  const Eigen::Vector2d along = half.x() * unit(yaw);
  const Eigen::Vector2d across = half.y() * unit(yaw + std::numbers::pi / 2);
  return {center + along + across, center - along + across, center - along - across,
          center + along - across};
}

/// Draws the structures of one kind, one at a time.
class Building {
public:
  using Draw = TerrainThing (Building::*)();

  Building(const Terrain& terrain, FreeGround& ground, Random random)
      : terrain_(terrain), ground_(ground), random_(random) {}

  void build(int count, Draw draw, std::vector<TerrainThing>& things) {
    constexpr double kGap = 0.4;
    for (int i = 0; i < count; ++i) {
      constexpr int kTries = 30;
      for (int j = 0; j < kTries; ++j) {
        TerrainThing thing = (this->*draw)();
        if (!ground_.has_room(thing.feature.footprint, kGap)) continue;
        ground_.take(thing.feature.footprint);
        things.push_back(std::move(thing));
        break;
      }
    }
  }

  TerrainThing facade();
  TerrainThing fence();
  TerrainThing car();
  TerrainThing pole();
  TerrainThing boom();
  TerrainThing debris();

private:
  /// A straight structure from its middle to both sides.
  struct Line {
    Eigen::Vector2d middle;
    double yaw, length;
    Eigen::Vector2d at(double along) const { return middle + along * unit(yaw); }
    /// The part that a place along it belongs to, from 1.
    std::uint16_t part(double along) const {
      const double parts = std::max(std::floor(length / kPart), 1.0);
      const double index = std::clamp((along + length / 2) / length * parts, 0.0, parts - 1);
      return static_cast<std::uint16_t>(index + 1);
    }
  };

  double ground_at(const Eigen::Vector2d& at) const { return terrain_.height(at.x(), at.y()); }
  Eigen::Vector3d above(const Eigen::Vector2d& at, double up) const {
    return {at.x(), at.y(), ground_at(at) + up};
  }
  Eigen::Vector2d near_way() {
    return ground_.near_way(terrain_.settings().placed_within, random_);
  }
  Line line_beside_way(double shortest, double longest);
  Line line_beyond_way(double shortest, double longest);
  void add(TerrainThing& thing, Volume volume, std::uint16_t part, double brightness);
  void add_wall(TerrainThing& thing, const Line& line, double from, double to, double recess,
                double height);
  void add_window(TerrainThing& thing, const Line& line, double along, double recess, double up);
  void finish(TerrainThing& thing, std::string_view name, const Eigen::Vector2d& at, double height,
              std::optional<Line> line = std::nullopt);

  const Terrain& terrain_;
  FreeGround& ground_;
  Random random_;
};

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
    most = std::max(most, by.dot(unit(away)));
  }
  const double off = way.empty() ? random_.uniform(0.2, 0.7) * terrain_.settings().placed_within
                                 : random_.uniform(2, 7);
  middle += (most + off - middle.dot(unit(away))) * unit(away);
  // Its left side looks away from the way.
  return {middle, away - std::numbers::pi / 2, random_.uniform(shortest, longest)};
}

void Building::add_wall(TerrainThing& thing, const Line& line, double from, double to,
                        double recess, double height) {
  constexpr double kThick = 0.3;
  const double middle = (from + to) / 2;
  const Eigen::Vector2d at =
      line.at(middle) + (recess + kThick / 2) * unit(line.yaw + std::numbers::pi / 2);
  const double tall = (height + kSunk) / 2;
  const Volume wall =
      Volume::block(above(at, tall - kSunk), {(to - from) / 2, kThick / 2, tall}, line.yaw);
  add(thing, wall, line.part(middle), random_.uniform(25, 60));
}

void Building::add_window(TerrainThing& thing, const Line& line, double along, double recess,
                          double up) {
  constexpr double kProud = 0.01;
  const Eigen::Vector2d at = line.at(along) + recess * unit(line.yaw + std::numbers::pi / 2);
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
  const Eigen::Vector2d middle = line.middle + thick / 2 * unit(line.yaw + std::numbers::pi / 2);
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
    const Eigen::Vector2d across = (width / 2 - 0.02) * unit(line.yaw + std::numbers::pi / 2);
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

/// A boom or log on two supports, or a table.
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

/// A small box, or a plank.
TerrainThing Building::debris() {
  TerrainThing debris;
  const Line line = line_beside_way(0.1, 0.5);
  const bool is_plank = random_.chance(0.4);
  const Eigen::Vector3d half =
      is_plank ? Eigen::Vector3d(random_.uniform(0.4, 1.3), random_.uniform(0.04, 0.12),
                                 random_.uniform(0.015, 0.05))
               : Eigen::Vector3d(line.length / 2, random_.uniform(0.05, 0.25),
                                 random_.uniform(0.05, 0.2));
  Volume box = Volume::block(above(line.middle, half.z()), half, random_.uniform(0, kTurn));
  const double yaw = std::atan2(box.axes(1, 0), box.axes(0, 0));
  add(debris, box, 1, random_.uniform(15, 70));
  debris.feature.footprint = rectangle(line.middle, half.head<2>(), yaw);
  debris.feature.is_small = 2 * half.z() < kLeastHeight;
  finish(debris, is_plank ? "plank" : "box", line.middle, 2 * half.z());
  return debris;
}

}  // namespace

std::vector<TerrainThing> draw_structures(const Terrain& terrain, FreeGround& ground,
                                          std::uint64_t seed) {
  const StructureCounts& counts = terrain.settings().structures;
  std::vector<TerrainThing> things;
  const auto add = [&](int count, Building::Draw draw, std::uint64_t stream) {
    Building(terrain, ground, Random(seed, stream)).build(count, draw, things);
  };
  add(counts.facades, &Building::facade, kFacades);
  add(counts.cars, &Building::car, kCars);
  add(counts.fences, &Building::fence, kFences);
  add(counts.booms, &Building::boom, kBooms);
  add(counts.poles, &Building::pole, kPoles);
  add(counts.debris, &Building::debris, kDebris);
  return things;
}

}  // namespace scree
