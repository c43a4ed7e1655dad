#pragma once

#include "scree/core/fixed_vector.hpp"
#include "scree/core/obstacle.hpp"

namespace scree {

/// Of a place from the box of an obstacle in the horizontal plane, metres; 0 inside.
double distance_to_box(const Obstacle& obstacle, const Eigen::Vector3d& place);

/// Joins obstacles of one kind that are pieces of one thing: shadows and the gaps between rings
/// break slivers off a rock, and a ditch into parts along its edge. The piece with the most points
/// stays, with a box that holds the others and the lowest of their ids; the obstacles come out by
/// their points, most first.
void join_pieces(FixedVector<Obstacle>& obstacles);

/// Takes out each hole whose middle lies in the box of a rock: it is what the rock hides. The order
/// stays.
void remove_shadows(FixedVector<Obstacle>& obstacles);

}  // namespace scree
