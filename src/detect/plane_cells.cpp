#include "scree/detect/plane_cells.hpp"

namespace scree {

PlaneCells::PlaneCells(std::size_t max_points) : sort_(max_points), points_(max_points) {}

void PlaneCells::build(PointView cloud, float radius) {
  inverse_ = 1.0F / cell_size(radius);
  column_range_ = row_range_ = {};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    column_range_.include(floor_to_cell(cloud.x[i] * inverse_));
    row_range_.include(floor_to_cell(cloud.y[i] * inverse_));
  }
  columns_ = column_range_.count() + 2ULL * kReach;

  sort_.clear();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::uint64_t column = column_range_.offset(floor_to_cell(cloud.x[i] * inverse_));
    const std::uint64_t row = row_range_.offset(floor_to_cell(cloud.y[i] * inverse_));
    sort_.push(key_at(row + kReach, column + kReach), i);
  }
  sort_.sort();

  points_.resize(cloud.size());
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t from = sort_.index(i);
    points_.x[i] = cloud.x[from];
    points_.y[i] = cloud.y[from];
    points_.z[i] = cloud.z[from];
    points_.reflectivity[i] = cloud.reflectivity[from];
  }
}

std::uint32_t PlaneCells::first_not_below(std::uint64_t key) const {
  std::size_t low = 0, high = size();
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (sort_.key(middle) < key) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return static_cast<std::uint32_t>(low);
}

}  // namespace scree
