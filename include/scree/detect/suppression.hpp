#pragma once

#include "scree/detect/candidate_points.hpp"
#include "scree/detect/plane_cells.hpp"

namespace scree {

/// Non-maximum suppression along the gradient (paper fig. 4): a point stays when its slope is at
/// least the mean slope of the edge points around each of two positions, half of `distance` up and
/// down its gradient.
struct Suppression {
  float distance;  ///< between the two positions, metres
  float radius;    ///< reach of the mean at each, metres

  /// How far from a point its neighbours matter.
  float reach() const { return distance / 2 + radius; }

  /// Writes what stays of `edges` to `kept`; `cells` is working memory.
  /// @pre kept and cells hold as many points as `edges`
  void suppress(const CandidatePoints& edges, PlaneCells& cells, CandidatePoints& kept) const;
};

}  // namespace scree
