#pragma once

#include <cstddef>
#include <scree/grid_t.hpp>
#include <scree/obstacle_list_t.hpp>

#include "scree/core/obstacle.hpp"
#include "scree/core/obstacle_grid.hpp"

namespace scree {

/// Takes memory for lists of so many obstacles. The message is then the longest of them.
void make_room(std::size_t obstacles, obstacle_list_t& message);

/// The LCM message of a list. Allocates only when the message's vectors have to grow: they may be
/// longer than the counts beside them say.
void to_message(const ObstacleList& list, obstacle_list_t& message);

/// The list of an LCM message. Allocates only when the list has to grow.
void from_message(const obstacle_list_t& message, ObstacleList& list);

/// Takes memory for the largest grid. The message is then one.
void make_room(grid_t& message);

/// The LCM message of a grid. Allocates only when the message's vectors have to grow, as for lists.
void to_message(const ObstacleGrid& grid, grid_t& message);

/// The grid of an LCM message. Allocates nothing. False, and of no cell, where the message
/// contradicts itself or holds what is no number.
bool from_message(const grid_t& message, ObstacleGrid& grid);

}  // namespace scree
