#pragma once

#include <string>

#include "draw/drawing.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/point_cloud.hpp"

namespace scree::cli {

/// Draws points and obstacles from above, x up and y to the left, as figure 17 of the paper does:
/// the ground as a hillshade, boxes of positive obstacles blue, of negative ones orange.
/// @param points, obstacles in the same frame, `base` at its origin
Drawing draw_top_view(const PointView& points, const FixedVector<Obstacle>& obstacles,
                      const std::string& title, const std::string& subtitle);

}  // namespace scree::cli
