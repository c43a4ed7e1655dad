#pragma once

#include <string>

#include "scree/core/obstacle.hpp"

namespace scree {

/// Appends a list as one line of JSON with its line feed. A number is written as the shortest text
/// that reads back as the same value, and as null when it is not finite. An obstacle without
/// evidence or without a footprint lacks that member. Allocates only when `text` has to grow.
void append_json_line(const ObstacleList& list, std::string& text);

}  // namespace scree
