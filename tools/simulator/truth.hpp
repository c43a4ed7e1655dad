#pragma once

#include <span>
#include <vector>

#include "scoring/truth.hpp"
#include "simulator/movers.hpp"
#include "simulator/terrain.hpp"

namespace scree {

/// The rocks and holes of a terrain and what moves on it, in its frame, with the names of their
/// shapes.
std::vector<TrueObstacle> true_obstacles(const Terrain& terrain,
                                         std::span<const Mover> movers = {});

}  // namespace scree
