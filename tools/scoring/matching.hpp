#pragma once

#include <vector>

#include "scoring/truth.hpp"

namespace scree {

/// What one list got right and wrong against one sweep's truth.
struct Comparison {
  /// An obstacle that was asked for.
  struct Asked {
    const TrueObstacle* obstacle;
    double range;   ///< of its centre from base in the x-y plane, metres
    bool is_right;  ///< matched, and of the right kind
  };
  /// A detection that is a false positive.
  struct FalseAlarm {
    const Obstacle* detection;
    double range;
  };
  std::vector<Asked> asked;  ///< in the order of the sweep's ids
  std::vector<FalseAlarm> false_alarms;
};

/// Scores one list. The truth is brought into base by the true pose at the list's stamp, detections
/// by the reported pose; footprints are those of the x-y plane there. A footprint lies at the
/// height of its obstacle's centre, a detection's at its own, its box where it has none. The result
/// points into truth and list. @pre the truth has poses, and every id an obstacle
Comparison compare(const Truth& truth, const Truth::Sight& sight, const ObstacleList& list);

}  // namespace scree
