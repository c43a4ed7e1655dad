#pragma once

#include <string>

#include "scree/core/obstacle.hpp"
#include "scree/core/obstacle_grid.hpp"

namespace scree {

/// Appends a list as one line of JSON with its line feed. A number is written as the shortest text
/// that reads back as the same value, and as null when it is not finite. An obstacle without
/// evidence or without a footprint lacks that member. Allocates only when `text` has to grow.
void append_json_line(const ObstacleList& list, std::string& text);

/// Appends a grid as one line of JSON with its line feed. Each row is a text of runs: a state, ?
/// (unknown) . (free) # (occupied) v (drop), behind how often it stands where that is more than
/// once. `ground` has the cells that are not unknown, in their order, centimetres above `base`.
void append_json_line(const ObstacleGrid& grid, std::string& text);

}  // namespace scree
