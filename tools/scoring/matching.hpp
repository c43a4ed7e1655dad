#pragma once

#include <vector>

#include "scoring/truth.hpp"

namespace scree {

/// What one list got right and wrong against one sweep's truth.
struct Comparison {
  /// An obstacle that was asked for.
  struct Asked {
    const TrueObstacle* obstacle;
    double range;               ///< of its centre from base in the x-y plane, metres
    const Obstacle* detection;  ///< matched, and of the right kind; null: missed
    bool is_right() const { return detection != nullptr; }
  };
  /// A detection that is a false positive.
  struct FalseAlarm {
    const Obstacle* detection;
    double range;
    bool is_ghost;  ///< it is said to move, or lies where a moving obstacle was seconds ago
  };
  std::vector<Asked> asked;  ///< in the order of the sweep's ids
  std::vector<FalseAlarm> false_alarms;
};

/// Scores one list. The truth is brought into base by the true pose at the list's stamp, detections
/// by the reported pose; footprints are those of the x-y plane there. A footprint lies at the
/// height of its obstacle's centre, a detection's at its own, its box where it has none. What moves
/// is taken where it is at the list's stamp. The result points into truth and list. @pre the truth
/// has poses, and every id an obstacle
Comparison compare(const Truth& truth, const Truth::Sight& sight, const ObstacleList& list);

}  // namespace scree
