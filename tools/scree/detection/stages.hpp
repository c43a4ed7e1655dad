#pragma once

#include <filesystem>

#include "scree/detect/detector.hpp"

namespace scree::cli {

/// Writes what each stage of the detector's last call gave as PCD files in `folder`, which is made:
/// the intensity field holds reflectivity, the slope (m/m) or the number of the block or cluster.
/// Throws Failure.
void write_stages(const Detector& detector, PointView input, const std::filesystem::path& folder);

/// One line: the points from stage to stage, as the paper gives them.
std::string chain(const StageCounts& counts);

}  // namespace scree::cli
