#include "scree/detect/overhangs.hpp"

#include <algorithm>
#include <limits>

namespace scree {

void Overhangs::remove(PointCloud& cloud, float clearance, PlaneCells& columns) {
  constexpr std::uint32_t kGroundRank = 2;  // from 0
  columns.build(cloud, kRadius);
  const PointCloud& sorted = columns.points();
  cloud.clear();
  columns.for_each_cell([&](Run column, std::span<const Run>) {
    float ceiling = std::numeric_limits<float>::max();
    if (column.end - column.begin > kGroundRank) {
      heights_.clear();
      for (std::uint32_t i = column.begin; i < column.end; ++i) heights_.push_back(sorted.z[i]);
      std::nth_element(heights_.begin(), heights_.begin() + kGroundRank, heights_.end());
      ceiling = heights_[kGroundRank] + clearance;
    }
    for (std::uint32_t i = column.begin; i < column.end; ++i) {
      if (sorted.z[i] > ceiling) continue;
      cloud.push_back(sorted.x[i], sorted.y[i], sorted.z[i], sorted.reflectivity[i]);
    }
  });
}

}  // namespace scree
