#pragma once

#include <functional>

#include "scree/app/detection_report.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/sweep.hpp"

namespace scree {

/// Finds the obstacles of one sweep. The list is valid until the next call, and null when nothing
/// is known of what is there. One thread calls it.
using SweepProcessor =
    std::function<const ObstacleList*(const Sweep& sweep, DetectionReport& report)>;

}  // namespace scree
