#pragma once

#include <filesystem>
#include <vector>

#include "scoring/truth.hpp"
#include "scree/core/result.hpp"
#include "simulator/terrain.hpp"

namespace scree {

/// The rocks and holes of a terrain, in its frame, with the names of their shapes.
std::vector<TrueObstacle> true_obstacles(const Terrain& terrain);

/// Writes truth.json with the terrain's obstacles in place of those of `truth`.
Result<void> write_truth(const std::filesystem::path& file, const Terrain& terrain, Truth truth);

}  // namespace scree
