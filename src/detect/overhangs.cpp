#include "scree/detect/overhangs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace scree {

void Overhangs::remove(PointCloud& cloud, float clearance) {
  // Wide enough to see some ground beside a trunk, narrow enough for a slope of 45 degrees to stay
  // within any sensible clearance.
  constexpr float kColumn = 1;  // metres
  const PlaneBounds bounds = bounds_of(cloud);
  float inverse = 1 / kColumn;
  float first_x = 0, first_y = 0;
  std::size_t across = 0, along = 0;
  for (;; inverse /= 2) {
    first_x = std::floor(bounds.low_x * inverse);
    first_y = std::floor(bounds.low_y * inverse);
    across = static_cast<std::size_t>(bounds.high_x * inverse - first_x) + 1;
    along = static_cast<std::size_t>(bounds.high_y * inverse - first_y) + 1;
    if (across * along <= columns_.capacity()) break;
  }
  const auto column_of = [&](std::size_t i) -> Column& {
    const auto x = static_cast<std::int32_t>(cloud.x[i] * inverse - first_x);
    const auto y = static_cast<std::int32_t>(cloud.y[i] * inverse - first_y);
    return columns_[static_cast<std::size_t>(y) * across + static_cast<std::size_t>(x)];
  };
  columns_.assign(across * along, {});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Column& column = column_of(i);
    const float z = cloud.z[i];
    const float above_lowest = std::max(column.lowest, z);
    const float above_second = std::max(column.second, above_lowest);
    column.lowest = std::min(column.lowest, z);
    column.second = std::min(column.second, above_lowest);
    column.third = std::min(column.third, above_second);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.z[i] > column_of(i).third + clearance) continue;
    cloud.x[kept] = cloud.x[i];
    cloud.y[kept] = cloud.y[i];
    cloud.z[kept] = cloud.z[i];
    cloud.reflectivity[kept] = cloud.reflectivity[i];
    ++kept;
  }
  cloud.resize(kept);
}

}  // namespace scree
