#include "scree/detect/space_cells.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

SpaceCells::SpaceCells(std::size_t max_points)
    : sort_(max_points), keys_(max_points), begin_(max_points + 1) {}

void SpaceCells::build(PointView points, float cell_size, float limit) {
  inverse_ = 1.0F / cell_size;
  // False for what is not finite, too.
  const auto inside = [&](std::size_t i) {
    return std::abs(points.x[i]) < limit && std::abs(points.y[i]) < limit &&
           std::abs(points.z[i]) < limit;
  };
  row_range_ = column_range_ = layer_range_ = {};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!inside(i)) continue;
    column_range_.include(floor_to_cell(points.x[i] * inverse_));
    row_range_.include(floor_to_cell(points.y[i] * inverse_));
    layer_range_.include(floor_to_cell(points.z[i] * inverse_));
  }
  columns_ = column_range_.count() + 2ULL * kReach;
  layers_ = layer_range_.count() + 2ULL * kReach;

  sort_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (inside(i)) sort_.push(key_at(points.x[i], points.y[i], points.z[i]), i);
  }
  sort_.sort();

  keys_.clear();
  begin_.clear();
  for (std::size_t i = 0; i < sort_.size(); ++i) {
    const std::uint64_t key = sort_.key(i);
    if (!keys_.empty() && key == keys_.back()) continue;
    keys_.push_back(key);
    begin_.push_back(static_cast<std::uint32_t>(i));
  }
  begin_.push_back(static_cast<std::uint32_t>(sort_.size()));
}

std::size_t SpaceCells::first_not_below(std::uint64_t key) const {
  return static_cast<std::size_t>(std::lower_bound(keys_.begin(), keys_.end(), key) -
                                  keys_.begin());
}

}  // namespace scree
