#include "scree/detect/overhangs.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace scree {
namespace {

/// Infinity where there are fewer.
float third_lowest(std::span<const float> heights) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  float first = kNone, second = kNone, third = kNone;
  for (const float height : heights) {
    const float above_first = std::max(first, height);
    const float above_second = std::max(second, above_first);
    first = std::min(first, height);
    second = std::min(second, above_first);
    third = std::min(third, above_second);
  }
  return third;
}

}  // namespace

void remove_overhangs(PointCloud& cloud, float clearance, PlaneCells& columns) {
  columns.build(cloud, kOverhangRadius);
  const PointCloud& sorted = columns.points();
  cloud.clear();
  columns.for_each_cell([&](Run column, std::span<const Run>) {
    const float ceiling =
        third_lowest({sorted.z.begin() + column.begin, sorted.z.begin() + column.end}) + clearance;
    for (std::uint32_t i = column.begin; i < column.end; ++i) {
      if (sorted.z[i] > ceiling) continue;
      cloud.push_back(sorted.x[i], sorted.y[i], sorted.z[i], sorted.reflectivity[i]);
    }
  });
}

}  // namespace scree
