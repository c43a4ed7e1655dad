#include "scree/detect/suppression.hpp"

#include <cmath>

namespace scree {
namespace {

struct Mean {
  float sum = 0;
  int count = 0;

  float value() const { return count == 0 ? 0.0F : sum / static_cast<float>(count); }
};

}  // namespace

void Suppression::suppress(const CandidatePoints& edges, PlaneCells& cells,
                           CandidatePoints& kept) const {
  cells.build(edges.points, reach());
  kept.clear();
  const PointCloud& points = cells.points();
  const auto slope = [&](std::uint32_t sorted) {
    const std::uint32_t i = cells.source(sorted);
    return std::hypot(edges.slope_x[i], edges.slope_y[i]);
  };
  cells.for_each_cell([&](Run cell, std::span<const Run> neighbourhood) {
    for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
      const std::uint32_t source = cells.source(i);
      const float steepness = slope(i);
      // A level point has no direction; both positions then fall on the point itself.
      const float half = steepness > 0 ? distance / (2 * steepness) : 0.0F;
      const float step_x = edges.slope_x[source] * half, step_y = edges.slope_y[source] * half;
      Mean above, below;
      for (const Run run : neighbourhood) {
        for (std::uint32_t j = run.begin; j < run.end; ++j) {
          const float dx = points.x[j] - points.x[i], dy = points.y[j] - points.y[i];
          const auto within = [&](float x, float y) { return x * x + y * y <= radius * radius; };
          const bool is_above = within(dx - step_x, dy - step_y);
          const bool is_below = within(dx + step_x, dy + step_y);
          if (!is_above && !is_below) continue;
          const float neighbour = slope(j);
          if (is_above) above = {above.sum + neighbour, above.count + 1};
          if (is_below) below = {below.sum + neighbour, below.count + 1};
        }
      }
      if (steepness >= above.value() && steepness >= below.value()) {
        kept.push_back(edges.points, source, edges.slope_x[source], edges.slope_y[source],
                       edges.height[source]);
      }
    }
  });
}

}  // namespace scree
