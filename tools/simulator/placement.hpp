#pragma once

#include <vector>

#include "scree/core/random.hpp"
#include "simulator/terrain.hpp"

namespace scree {

/// What is put onto a finished ground: a plant or a structure, and what the truth says of it.
struct TerrainThing {
  TerrainFeature feature;               ///< without id and parts
  std::vector<Volume> volumes;          ///< their parts count from 1 within the thing, 0 for none
  std::vector<Eigen::Vector2d> places;  ///< of the parts
};

/// Where on a terrain something can still be put.
class FreeGround {
public:
  /// Keeps a reference to the terrain. What it has stands in the way.
  explicit FreeGround(const Terrain& terrain);

  /// Whether a footprint lies on the terrain, clear of the robot's way and of what is there.
  /// @param gap least distance of two things
  bool has_room(const Footprint& footprint, double gap) const;
  void take(const Footprint& footprint);
  /// A place anywhere on the terrain.
  Eigen::Vector2d anywhere(Random& random) const;
  /// A place at most this far from the robot's way; without one, from the origin.
  Eigen::Vector2d near_way(double within, Random& random) const;
  /// Least distance of a place from the robot's way, metres.
  double from_way(const Eigen::Vector2d& place) const;
  /// Direction of the robot's way where it comes nearest, radians; without one any.
  double way_beside(const Eigen::Vector2d& place, Random& random) const;

private:
  struct Taken {
    Footprint footprint;
    Eigen::Vector2d center;
    double reach;
  };
  const Terrain& terrain_;
  std::vector<Taken> taken_;
};

}  // namespace scree
