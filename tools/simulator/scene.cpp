#include "simulator/scene.hpp"

#include <algorithm>
#include <cmath>

#include "simulator/scene_counts.hpp"

namespace scree {
namespace {

struct Range {
  double low, high;
  double draw(Random& random) const { return random.uniform(low, high); }
};

/// What makes a scene. Shares are of the number of obstacles.
struct Recipe {
  std::string_view name;
  Range slope_deg;
  double roughness;  ///< metres
  Range unevenness;  ///< metres
  Range tuft_cover;
  Range negative;  ///< the rest are rocks
  Range smooth, small, pairs, neighbours, nests;
  ShapeWeights weights;
};

constexpr Range kNone = {0, 0};

//                                 boulder block peak bump log ledge pillar | bowl pit pothole
//                                 crater ditch
constexpr std::array<Recipe, kScenes.size()> kRecipes = {{
    {"easy",
     {0.5, 4},
     0.006,
     kNone,
     kNone,
     {0.2, 0.5},
     {0.1, 0.4},
     {0, 0.2},
     {0, 0.15},
     {0, 0.05},
     kNone,
     {4, 2, 2, 1, 1, 1, 3, 1, 2, 2, 1, 1, 1, 1}},
    {"rolling",
     {5, 15},
     0.012,
     {0, 0.01},
     {0, 0.03},
     {0.2, 0.5},
     {0.4, 1.0},
     {0, 0.3},
     {0, 0.2},
     {0, 0.1},
     {0, 0.25},
     {3, 2, 2, 2, 1, 1, 2, 2, 2, 2, 2, 1, 1, 1}},
    {"rough",
     {3, 10},
     0.02,
     {0.015, 0.035},
     {0, 0.05},
     {0.2, 0.5},
     {0.2, 0.6},
     {0.3, 1.2},
     {0, 0.2},
     {0, 0.1},
     {0, 0.1},
     {3, 3, 2, 2, 1, 1, 2, 2, 2, 2, 2, 1, 1, 1}},
    {"crater",
     {2, 9},
     0.012,
     {0, 0.02},
     kNone,
     {0.6, 0.9},
     {0.3, 0.8},
     {0, 0.4},
     {0, 0.1},
     {0, 0.15},
     {0.1, 0.4},
     {3, 2, 2, 1, 1, 1, 2, 2, 2, 3, 5, 0, 1, 3}},
    {"ditch",
     {1, 8},
     0.012,
     {0, 0.015},
     {0, 0.05},
     {0.4, 0.7},
     {0.1, 0.5},
     {0, 0.3},
     {0, 0.1},
     {0, 0.1},
     {0, 0.1},
     {2, 1, 1, 1, 3, 4, 2, 1, 1, 1, 1, 6, 1, 1}},
    {"grass",
     {1, 8},
     0.015,
     {0, 0.015},
     {0.1, 0.45},
     {0.2, 0.5},
     {0.2, 0.6},
     {0, 0.3},
     {0, 0.15},
     {0, 0.1},
     {0, 0.15},
     {3, 2, 2, 2, 2, 1, 3, 1, 2, 2, 2, 2, 1, 1}},
    {"mixed",
     {1, 13},
     0.015,
     {0, 0.03},
     {0, 0.15},
     {0.25, 0.6},
     {0.2, 0.8},
     {0, 0.6},
     {0, 0.25},
     {0, 0.15},
     {0, 0.25},
     {3, 2, 2, 2, 2, 2, 3, 2, 2, 2, 3, 2, 1, 1}},
    {"cliff",
     {1, 10},
     0.015,
     {0, 0.02},
     {0, 0.08},
     {0.2, 0.6},
     {0.2, 0.6},
     {0, 0.4},
     {0, 0.15},
     {0, 0.1},
     {0, 0.15},
     {3, 2, 2, 2, 1, 2, 2, 2, 2, 2, 3, 1, 1, 1}},
    {"kerb",
     {0.2, 3},
     0.005,
     kNone,
     kNone,
     {0.2, 0.5},
     {0, 0.1},
     {0, 0.3},
     {0, 0.1},
     {0, 0.1},
     kNone,
     {1, 4, 1, 1, 1, 2, 5, 1, 3, 3, 1, 1, 1, 1}},
    {"wood",
     {2, 14},
     0.02,
     {0.005, 0.03},
     {0, 0.2},
     {0.2, 0.5},
     {0.2, 0.8},
     {0, 0.6},
     {0, 0.15},
     {0, 0.1},
     {0, 0.2},
     {3, 2, 2, 2, 4, 1, 2, 2, 2, 2, 2, 1, 1, 1}},
    {"meadow",
     {1, 8},
     0.015,
     {0, 0.02},
     {0, 0.2},
     {0.2, 0.5},
     {0.2, 0.6},
     {0, 0.3},
     {0, 0.1},
     {0, 0.1},
     {0, 0.15},
     {3, 1, 1, 2, 2, 1, 2, 1, 2, 2, 2, 3, 1, 1}},
    {"boulders",
     {3, 18},
     0.015,
     {0, 0.02},
     kNone,
     {0.1, 0.4},
     kNone,
     kNone,
     kNone,
     kNone,
     kNone,
     {3, 4, 1, 0, 2, 0, 0, 1, 2, 2, 0, 0, 1, 1}},
    {"street",
     {0.2, 3},
     0.004,
     kNone,
     kNone,
     {0.1, 0.4},
     {0, 0.1},
     {0, 0.2},
     {0, 0.1},
     {0, 0.05},
     kNone,
     {1, 3, 1, 0, 0, 1, 6, 0, 3, 3, 0, 1, 1, 1}},
    {"quarry",
     {1, 12},
     0.02,
     {0.005, 0.03},
     {0, 0.05},
     {0.1, 0.4},
     {0.1, 0.6},
     {0, 0.6},
     {0, 0.2},
     {0, 0.1},
     {0, 0.1},
     {3, 4, 3, 2, 1, 2, 2, 1, 2, 2, 2, 1, 1, 1}},
}};

const Recipe& recipe_of(Scene scene) {
  return kRecipes[static_cast<std::size_t>(scene)];
}

}  // namespace

std::string_view name_of(Scene scene) {
  return recipe_of(scene).name;
}

std::optional<Scene> scene_named(std::string_view name) {
  for (const Scene scene : kScenes) {
    if (name_of(scene) == name) return scene;
  }
  return std::nullopt;
}

TerrainSettings scene_terrain(Scene scene, double area, std::uint64_t seed) {
  constexpr Range kObstaclesPerSquareMetre = {0.03, 0.1}, kUndercut = {0.1, 0.7};
  const Recipe& recipe = recipe_of(scene);
  Random random(seed, 0x5CE);
  const double obstacles = std::max(area * kObstaclesPerSquareMetre.draw(random), 4.0);
  const auto count = [&](const Range& share) {
    return static_cast<int>(std::lround(obstacles * share.draw(random)));
  };
  TerrainSettings settings;
  settings.gentlest_slope_deg = recipe.slope_deg.low;
  settings.steepest_slope_deg = recipe.slope_deg.high;
  settings.roughness = recipe.roughness;
  settings.unevenness = recipe.unevenness.draw(random);
  settings.tuft_cover = recipe.tuft_cover.draw(random);
  settings.tuft_light = 0.15;  // a denser one is a rock to a lidar, and may well hide one
  settings.negative = std::max(count(recipe.negative), 1);
  settings.positive = std::max(static_cast<int>(std::lround(obstacles)) - settings.negative, 1);
  settings.smooth = count(recipe.smooth);
  settings.small = count(recipe.small);
  settings.pairs = count(recipe.pairs);
  settings.neighbours = count(recipe.neighbours);
  settings.nests = count(recipe.nests);
  settings.weights = recipe.weights;
  settings.undercut = kUndercut.draw(random);
  if (scene == Scene::boulders) {
    constexpr Range kCover = {0.2, 0.65};
    constexpr double kOthers = 0.3;  // share of the rocks and holes of other scenes
    settings.positive = std::max(static_cast<int>(kOthers * settings.positive), 2);
    settings.negative = std::max(static_cast<int>(kOthers * settings.negative), 1);
    settings.boulder_cover = kCover.draw(random);
  }
  settings.edges = edges_of(scene, seed);
  settings.plants = plants_of(scene, seed);
  settings.structures = structures_of(scene, seed);
  settings.diggings = diggings_of(scene, seed);
  return settings;
}

TerrainSettings cloud_terrain(Scene scene, std::uint64_t seed) {
  const double edge = 2 * TerrainSettings().placed_within;
  constexpr double kSparser = 0.5;  // a place that was worth mapping whole is less crowded
  TerrainSettings settings = scene_terrain(scene, kSparser * edge * edge, seed);
  settings.tuft_light = 0;  // there the light is lost that would tell
  settings.undercut = 0;    // and from above nothing is seen below an edge
  settings.weights[static_cast<std::size_t>(ShapeKind::pillar)] = 0;  // as in the paper's fields
  return settings;
}

TerrainSettings scene_terrain() {
  TerrainSettings settings;
  settings.size = 64;
  settings.placed_within = 10;
  settings.clear_radius = 1.5;
  settings.level_radius = 0.8;
  return settings;
}

LidarSettings scene_lidar() {
  LidarSettings lidar;
  lidar.translation = {0.10, 0.0, 0.95};
  lidar.rpy_deg = {0, 6, 0};
  return lidar;
}

}  // namespace scree
