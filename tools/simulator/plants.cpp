#include "simulator/plants.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scree/core/pose.hpp"
#include "simulator/curves.hpp"
#include "simulator/noise.hpp"

namespace scree {
namespace {

enum PlantStream : std::uint64_t { kTrees = 800, kBushes, kHedges, kTallGrass };

constexpr double kLeastBush = 0.5;      // metres: lower ones are not asked for
constexpr double kThinnestBush = 0.45;  // share of the light that passes: nor are thinner ones
constexpr double kClearance = 1.5;      // metres: what hangs higher is not in the way

/// So that this share of the light passes a path of this length.
double density_for(double light, double path) {
  return -std::log(light) / path;
}

void add_circle(std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& center,
                double radius) {
  constexpr int kCorners = 16;
  for (int i = 0; i < kCorners; ++i) {
    points.emplace_back(center + radius * unit_vector(kTurn * i / kCorners));
  }
}

/// What all plants of one kind have in common: how they come onto the ground.
class Planting {
public:
  Planting(const Terrain& terrain, FreeGround& ground, Random random)
      : terrain_(terrain), ground_(ground), random_(random) {}

  void plant(double count, TerrainThing (Planting::*draw)(const Eigen::Vector2d&), double within,
             double gap) {
    for (int i = 0; i < static_cast<int>(count); ++i) {
      constexpr int kTries = 20;
      for (int j = 0; j < kTries; ++j) {
        const Eigen::Vector2d at =
            within > 0 ? ground_.near_way(within, random_) : ground_.anywhere(random_);
        if (!terrain_.covers(at.x(), at.y())) continue;
        TerrainThing thing = (this->*draw)(at);
        if (!ground_.has_room(thing.feature.footprint, gap)) continue;
        ground_.take(thing.feature.footprint);
        things_.push_back(std::move(thing));
        break;
      }
    }
  }

  TerrainThing tree(const Eigen::Vector2d& at);
  TerrainThing bush(const Eigen::Vector2d& at);
  TerrainThing hedge(const Eigen::Vector2d& at);

  std::vector<TerrainThing> things() && { return std::move(things_); }

private:
  Eigen::Vector3d on_ground(const Eigen::Vector2d& at) const {
    return {at.x(), at.y(), terrain_.height(at.x(), at.y())};
  }
  Volume leaves(const Eigen::Vector3d& center, double radius, double half_height, double density) {
    Volume lobe = Volume::tuft(center, radius, half_height, density);
    lobe.part = 1;
    return lobe;
  }
  /// Anywhere around, this far.
  Eigen::Vector2d aside(double least, double most) {
    const double away = random_.uniform(least, most);
    return away * unit_vector(random_.uniform(0, kTurn));
  }
  void add_trunk(TerrainThing& tree, const Eigen::Vector3d& foot, double radius, double height);
  void add_crown(TerrainThing& tree, const Eigen::Vector3d& foot, double from, double to);
  void add_cone(TerrainThing& tree, const Eigen::Vector3d& foot, double from, double to);
  void finish(TerrainThing& thing, std::string_view name, const Eigen::Vector2d& at, double height);

  const Terrain& terrain_;
  FreeGround& ground_;
  Random random_;
  std::vector<TerrainThing> things_;
};

void Planting::finish(TerrainThing& thing, std::string_view name, const Eigen::Vector2d& at,
                      double height) {
  thing.feature.name = name;
  thing.feature.kind = ObstacleKind::positive;
  thing.feature.height = height;
  thing.feature.center = on_ground(at) + Eigen::Vector3d(0, 0, height / 2);
  if (thing.places.empty()) thing.places = {at};
}

void Planting::add_trunk(TerrainThing& tree, const Eigen::Vector3d& foot, double radius,
                         double height) {
  constexpr double kRoots = 0.2;
  constexpr double kMostLean = 0.08;  // metres a metre
  const Eigen::Vector2d lean = aside(0, kMostLean);
  Volume trunk = Volume::rod(foot - Eigen::Vector3d(0, 0, kRoots),
                             foot + height * Eigen::Vector3d(lean.x(), lean.y(), 1), radius);
  trunk.part = 1;
  trunk.darkest = 15;
  trunk.brightest = 45;
  tree.volumes.push_back(trunk);
}

void Planting::add_crown(TerrainThing& tree, const Eigen::Vector3d& foot, double from, double to) {
  const double spread = std::min(0.35 * to, 3.0) * random_.uniform(0.5, 1);
  const int lobes = 4 + static_cast<int>(random_.index(5));
  for (int i = 0; i < lobes; ++i) {
    const double radius = spread * random_.uniform(0.45, 0.8);
    const double half_height = std::min(radius * random_.uniform(0.5, 0.9), (to - from) / 2);
    const double up =
        random_.uniform(from + half_height, std::max(to - half_height, from + half_height));
    const Eigen::Vector2d off = spread * aside(0, 0.7);
    tree.volumes.push_back(leaves(foot + Eigen::Vector3d(off.x(), off.y(), up), radius, half_height,
                                  density_for(random_.uniform(0.25, 0.75), 2 * radius)));
  }
}

void Planting::add_cone(TerrainThing& tree, const Eigen::Vector3d& foot, double from, double to) {
  const int whorls = 4 + static_cast<int>(random_.index(4));
  const double widest = std::min(0.25 * to, 1.8) * random_.uniform(0.6, 1);
  for (int i = 0; i < whorls; ++i) {
    const double share = static_cast<double>(i) / whorls;
    const double radius = widest * (1 - 0.85 * share);
    const double half_height = 0.6 * (to - from) / whorls;
    tree.volumes.push_back(
        leaves(foot + Eigen::Vector3d(0, 0, from + half_height + share * (to - from)), radius,
               half_height, density_for(random_.uniform(0.1, 0.5), 2 * radius)));
  }
}

TerrainThing Planting::tree(const Eigen::Vector2d& at) {
  TerrainThing tree;
  const double drawn = random_.uniform();
  const double thickness = 0.04 + 0.26 * drawn * drawn;
  const double height = std::clamp(3 + 22 * thickness * random_.uniform(0.7, 1.3), 3.0, 12.0);
  const bool is_conifer = random_.chance(0.3);
  const double crown = is_conifer ? random_.uniform(0.2, 2) : random_.uniform(1.3, 0.45 * height);
  const int stems = random_.chance(0.12) ? 2 + static_cast<int>(random_.index(2)) : 1;
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < stems; ++i) {
    const Eigen::Vector2d off = stems > 1 ? aside(0.1, 0.4) : Eigen::Vector2d(0, 0);
    add_trunk(tree, on_ground(at + off), thickness, 0.75 * height);
    add_circle(outline, at + off, std::max(thickness, 0.1));
  }
  const Eigen::Vector3d foot = on_ground(at);
  is_conifer ? add_cone(tree, foot, crown, height) : add_crown(tree, foot, crown, height);
  for (const Volume& lobe : tree.volumes) {
    const bool hangs_low = lobe.form == Volume::Form::ellipsoid &&
                           lobe.center.z() - lobe.half.z() - foot.z() < kClearance;
    if (hangs_low) add_circle(outline, lobe.center.head<2>(), 0.85 * lobe.half.x());
  }
  tree.feature.footprint = hull(std::move(outline));
  finish(tree, "tree", at, height);
  return tree;
}

TerrainThing Planting::bush(const Eigen::Vector2d& at) {
  TerrainThing bush;
  const double height =
      random_.chance(0.2) ? random_.uniform(0.25, 0.5) : random_.uniform(0.5, 2.4);
  const double radius = std::clamp(height * random_.uniform(0.35, 0.9), 0.2, 1.6);
  const double light =
      random_.chance(0.2) ? random_.uniform(kThinnestBush, 0.7) : random_.uniform(0.02, 0.4);
  const int lobes = 3 + static_cast<int>(random_.index(5));
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < lobes; ++i) {
    const double wide = radius * random_.uniform(0.45, 0.75);
    const Eigen::Vector2d off =
        i == 0 ? Eigen::Vector2d(0, 0) : aside(radius - wide, radius - wide);
    const double tall = i == 0 ? height : height * random_.uniform(0.5, 0.95);
    // The leaves begin at the ground or a little above it.
    const double bottom = random_.uniform(-0.3, 0.2) * tall;
    Eigen::Vector3d center = on_ground(at + off);
    center.z() += (bottom + tall) / 2;
    // Two lobes overlap in the middle.
    bush.volumes.push_back(
        leaves(center, wide, (tall - bottom) / 2, density_for(light, 2.5 * radius)));
    add_circle(outline, at + off, wide);
  }
  bush.feature.footprint = hull(std::move(outline));
  bush.feature.is_small = height < kLeastBush || light >= kThinnestBush;
  finish(bush, "bush", at, height);
  return bush;
}

TerrainThing Planting::hedge(const Eigen::Vector2d& at) {
  TerrainThing hedge;
  const double length = random_.uniform(3, 18);
  const double height = random_.uniform(0.4, 2.2);
  const double width = random_.uniform(0.4, 1.2);
  const double light = random_.uniform(0.02, 0.6);
  const bool is_trimmed = random_.chance(0.4);
  const double bend = random_.uniform(-0.02, 0.02);
  const double yaw = ground_.way_beside(at, random_) + random_.uniform(-0.3, 0.3);
  const Eigen::Vector2d along = unit_vector(yaw);
  const Eigen::Vector2d across(-along.y(), along.x());
  constexpr double kPiece = 0.5;
  const auto steps = static_cast<int>(length / kPiece);
  Footprint other_side;
  for (int i = 0; i <= steps; ++i) {
    const double u = kPiece * i - length / 2;
    const Eigen::Vector2d middle = at + u * along + bend * u * u * across;
    if (i % 2 == 0) hedge.places.push_back(middle);
    const auto part = static_cast<std::uint16_t>(hedge.places.size());
    const double tall = is_trimmed ? height : height * random_.uniform(0.7, 1);
    const double wide = is_trimmed ? width : width * random_.uniform(0.7, 1);
    Volume piece = leaves(on_ground(middle), wide / 2, tall, density_for(light, width));
    if (is_trimmed) {
      piece = Volume::block(on_ground(middle), {kPiece / 2, wide / 2, tall}, yaw);
      piece.density = density_for(light, width);
    } else {
      piece.half.x() = piece.half.y() = std::max(wide / 2, 0.6 * kPiece);
    }
    piece.part = part;
    piece.darkest = 20;
    piece.brightest = 50;
    hedge.volumes.push_back(piece);
    hedge.feature.footprint.emplace_back(middle - width / 2 * across);
    other_side.emplace_back(middle + width / 2 * across);
  }
  hedge.feature.footprint.insert(hedge.feature.footprint.end(), other_side.rbegin(),
                                 other_side.rend());
  hedge.feature.is_small = height < kLeastBush || light >= kThinnestBush;
  finish(hedge, "hedge", at, height);
  return hedge;
}

}  // namespace

std::vector<TerrainThing> draw_plants(const Terrain& terrain, FreeGround& ground,
                                      std::uint64_t seed) {
  const PlantCounts& counts = terrain.settings().plants;
  const double area = 4 * terrain.half_size() * terrain.half_size();
  std::vector<TerrainThing> things;
  const auto add = [&](double count, TerrainThing (Planting::*draw)(const Eigen::Vector2d&),
                       double within, double gap, std::uint64_t stream) {
    Planting planting(terrain, ground, Random(seed, stream));
    planting.plant(count, draw, within, gap);
    for (TerrainThing& thing : std::move(planting).things()) things.push_back(std::move(thing));
  };
  add(counts.hedges, &Planting::hedge, terrain.settings().placed_within, 0.5, kHedges);
  add(counts.trees * area, &Planting::tree, 0, 0.3, kTrees);
  add(counts.bushes * area, &Planting::bush, 0, 0.4, kBushes);
  return things;
}

std::vector<Volume> grow_tall_grass(const Terrain& terrain, const FreeGround& ground,
                                    std::uint64_t seed) {
  const PlantCounts& counts = terrain.settings().plants;
  if (counts.tall_grass <= 0) return {};
  Random random(seed, kTallGrass);
  const double half = terrain.half_size();
  const double tallest = random.uniform(0.35, 1.0);
  const double least_light = random.uniform(0.2, 0.7);
  const double verge = terrain.settings().corridor_half_width * random.uniform(0.4, 0.9);
  const GradientNoise meadows(Random(seed, kTallGrass + 100), 2 * half, 6);
  const double wanted = -std::log(1 - std::min(counts.tall_grass, 0.9)) * 4 * half * half;
  std::vector<Volume> grass;
  for (double covered = 0; covered < wanted;) {
    const double radius = random.uniform(0.12, 0.4);
    covered += std::numbers::pi * radius * radius;
    const Eigen::Vector2d at = ground.anywhere(random);
    const double patch = meadows(at.x(), at.y());
    const double height = tallest * random.uniform(0.4, 1) * (patch < 0 ? 0.5 : 1);
    const double light = random.uniform(least_light, 0.9);
    if (patch < -0.15 || terrain.is_obstacle_at(at.x(), at.y())) continue;
    if (ground.from_way(at) < verge) continue;
    grass.push_back(Volume::tuft({at.x(), at.y(), terrain.height(at.x(), at.y())}, radius, height,
                                 density_for(light, 2 * radius)));
  }
  return grass;
}

}  // namespace scree
