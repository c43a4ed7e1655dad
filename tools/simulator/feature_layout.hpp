#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "simulator/shape.hpp"
#include "simulator/terrain_settings.hpp"

namespace scree {

/// A shape and where its origin lies on the terrain.
struct PlacedShape {
  Shape shape;
  Eigen::Vector2d center{0, 0};
  int partner = -1;       ///< index of the obstacle that it was put close to, -1 for none
  bool is_small = false;  ///< too low or too shallow to be asked for
};

/// Whether something lies within a distance of a place.
using IsTaken = std::function<bool(const Eigen::Vector2d& place, double distance)>;

/// Where the rocks, holes, mounds and hollows of a terrain stand: at least `gap` apart but for the
/// pairs and nests that are meant to be close, and none in the corridor. A mound or hollow comes
/// before the obstacle that lies on it, which may also stick out of it. Shapes for which there is
/// no room are left out.
/// @param is_taken whether something else lies there; empty: there is nothing
std::vector<PlacedShape> lay_out_features(const TerrainSettings& settings, std::uint64_t seed,
                                          const IsTaken& is_taken = {});

}  // namespace scree
