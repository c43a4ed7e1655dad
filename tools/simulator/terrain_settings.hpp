#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "simulator/shape.hpp"

namespace scree {

/// How often each kind of shape is drawn among its like (rocks, holes, smooth ones).
using ShapeWeights = std::array<double, kShapeKinds>;
inline constexpr ShapeWeights kRocksAndHoles = {1, 1, 1, 1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1};

/// How many edges of which kind a terrain has: see TerrainEdgeKind.
struct EdgeCounts {
  int cliffs = 0, kerbs = 0, banks = 0, stairs = 0, ditches = 0, pits = 0;
  int ploughed = 0;  ///< fields of furrows
  int ruts = 0;      ///< pairs of them; they may cross the robot's way
  bool any() const {
    return cliffs + kerbs + banks + stairs + ditches + pits + ploughed + ruts > 0;
  }
};

/// What grows on a terrain beside tufts of grass.
struct PlantCounts {
  double trees = 0, bushes = 0;  ///< a square metre
  int hedges = 0;
  double tall_grass = 0;  ///< share of the ground under it
};

/// What has been built on a terrain, and what lies about.
struct StructureCounts {
  int facades = 0, fences = 0, cars = 0, poles = 0, booms = 0, debris = 0;
};

/// What has been dug into a terrain: craters with a rim thrown up around them, still water.
struct DiggingCounts {
  int rimmed_craters = 0, ponds = 0;
};

/// How a terrain is drawn. Lengths in metres.
struct TerrainSettings {
  double size = 40;               ///< edge of the square, centred on the origin
  double cell = 0.02;             ///< distance of the raster's heights
  double gentlest_slope_deg = 4;  ///< the rolling ground's steepest slope is drawn between these
  double steepest_slope_deg = 15;
  double roughness = 0.012;  ///< most height of stones and grass roots too small to matter
  double unevenness = 0;     ///< standard deviation of waves 0.3 to 2 m long
  double tuft_cover = 0;     ///< share of the ground under tufts of grass
  double tuft_light = 0;     ///< least share of the light that passes through a tuft's middle
  int positive = 11;         ///< rocks
  int negative = 7;          ///< holes
  int smooth = 8;            ///< mounds and hollows that are no obstacles
  int small = 0;             ///< stones and dents that are neither asked for nor wrong
  int pairs = 1;             ///< of the rocks: two 0.3-0.6 m apart
  int neighbours = 0;        ///< of rocks and holes: a pothole 0.3-0.6 m beside a rock
  int nests = 0;             ///< of rocks, holes and smooth ones: one inside a hollow or on a mound
  double undercut = 0;       ///< share of the rocks that are narrower at the ground than above
  ShapeWeights weights = kRocksAndHoles;
  double boulder_cover = 0;  ///< share of the ground under boulders that touch and overlap
  EdgeCounts edges;
  PlantCounts plants;
  StructureCounts structures;
  DiggingCounts diggings;
  double placed_within = 18;  ///< features lie in the square from -this to this, or, where there is
                              ///< a corridor, this close to it
  double gap = 0.6;           ///< least distance of two features' rims
  double clear_radius = 0;    ///< no feature this close to the origin, where the robot stands
  double level_radius = 0;    ///< the ground is level this far around the origin
  std::vector<Eigen::Vector2d> corridor;  ///< points along a robot's way, at most 0.5 m apart
  double corridor_half_width = 1;         ///< no rock and no hole this close to the way
};

}  // namespace scree
