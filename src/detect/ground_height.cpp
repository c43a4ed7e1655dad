#include "scree/detect/ground_height.hpp"

#include <cmath>

#include "scree/detect/quantile.hpp"

namespace scree {

GroundHeight::GroundHeight(float inner, float outer, std::size_t max_points)
    : inner_(inner), outer_(outer), heights_(max_points) {}

float GroundHeight::around(const OrientedBox& box, const PlaneCells& cells,
                           std::span<const std::uint8_t> is_edge, float otherwise) {
  constexpr std::size_t kEnough = 8;
  const PointCloud& points = cells.points();
  const auto distance_of = box.distances();
  float outer = outer_;
  for (int widening = 0; widening < 4; ++widening, outer *= 2) {
    heights_.clear();
    const float reach = std::hypot(box.length, box.width) / 2 + outer;
    cells.for_each_run(box.center_x - reach, box.center_x + reach, box.center_y - reach,
                       box.center_y + reach, [&](Run run) {
                         for (std::uint32_t i = run.begin; i < run.end; ++i) {
                           if (is_edge[i] != 0) continue;
                           const float distance = distance_of(points.x[i], points.y[i]);
                           if (distance >= inner_ && distance <= outer) {
                             heights_.push_back(points.z[i]);
                           }
                         }
                       });
    if (heights_.size() < kEnough) continue;
    return quantile({heights_.data(), heights_.size()}, 0.5);
  }
  return otherwise;
}

}  // namespace scree
