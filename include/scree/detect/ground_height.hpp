#pragma once

#include <span>

#include "scree/detect/oriented_box.hpp"
#include "scree/detect/plane_cells.hpp"

namespace scree {

/// Height of the ground around a cluster: the median of the points that are no edge, in a ring
/// between two distances around its box. Where the ring is nearly empty it is widened.
class GroundHeight {
public:
  GroundHeight(float inner, float outer, std::size_t max_points);

  /// @param is_edge for each sorted point of `cells`, not zero when it is steep
  /// @return z in metres; `otherwise` where nothing around the box is known
  float around(const OrientedBox& box, const PlaneCells& cells,
               std::span<const std::uint8_t> is_edge, float otherwise);

private:
  float inner_, outer_;  // metres
  FixedVector<float> heights_;
};

}  // namespace scree
