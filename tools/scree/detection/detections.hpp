#pragma once

#include <filesystem>
#include <vector>

#include "scree/core/obstacle.hpp"

namespace scree::cli {

/// Reads a file of obstacle lists, one JSON object a line, as append_json_line writes them, or an
/// LCM log of them. Lines of health are passed over. A footprint of another program that is not
/// convex or has too many corners becomes the polygon around it. Throws Failure that names file and
/// line where one is not an obstacle list, or earlier than the one before it.
std::vector<ObstacleList> read_detections(const std::filesystem::path& file);

}  // namespace scree::cli
