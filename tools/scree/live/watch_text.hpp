#pragma once

#include <scree/grid_t.hpp>
#include <scree/health_t.hpp>
#include <string>

#include "scree/core/obstacle.hpp"

namespace scree::cli {

/// Appends a list for people: a line with its time and one line for each obstacle.
void append_text(const ObstacleList& list, std::string& text);
/// Appends a grid for people: a line that says how many of its cells are in each state.
void append_text(const grid_t& grid, std::string& text);
/// Appends health for people: one line, one for each sensor, one of the detector's work once there
/// is any, and one more where things were dropped.
void append_text(const health_t& health, std::string& text);

}  // namespace scree::cli
