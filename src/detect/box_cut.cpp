#include "scree/detect/box_cut.hpp"

#include <algorithm>

namespace scree {

float area_of(const OrientedBox& box) {
  constexpr float kLeastWidth = 0.3F;  // metres
  return box.length * std::max(box.width, kLeastWidth);
}

BestCut best_cut(PointView points, std::span<std::uint32_t> indices, const OrientedBox& box,
                 float strip) {
  BestCut best;
  for (const bool is_across : {true, false}) {
    const float half = (is_across ? box.length : box.width) / 2;
    for (const float place : {strip - half, -half / 3, 0.0F, half / 3, half - strip}) {
      const BoxCut cut(box, is_across, place);
      const auto middle = std::partition(indices.begin(), indices.end(), [&](std::uint32_t i) {
        return cut.has_first(points.x[i], points.y[i]);
      });
      if (middle == indices.begin() || middle == indices.end()) continue;
      const float area = area_of(smallest_box(points, {indices.begin(), middle})) +
                         area_of(smallest_box(points, {middle, indices.end()}));
      if (area < best.area) best = {cut, area};
    }
  }
  return best;
}

}  // namespace scree
