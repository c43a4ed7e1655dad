#pragma once

#include <string>

#include "scree/core/obstacle.hpp"

namespace scree {

/// Appends a list as one line of JSON with its line feed. Numbers are the shortest that read back
/// as the same value; one that is not finite is written as null. Allocates only when `text` has to
/// grow.
void append_json_line(const ObstacleList& list, std::string& text);

}  // namespace scree
