#pragma once

#include <cstddef>
#include <limits>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/point_cloud.hpp"

namespace scree {

/// Removes what the robot passes under: branches, ceilings, bridges. The paper has no such stage,
/// but an elevation that averages a canopy with the ground below it is nobody's height.
class Overhangs {
public:
  /// @param max_columns of the plane; where a cloud needs more, they are twice as wide, or four
  /// times
  explicit Overhangs(std::size_t max_columns) : columns_(max_columns) {}

  /// Takes out of `cloud` the points more than `clearance` metres above the ground of their column.
  /// That ground is the third-lowest point, so that one or two stray points below it do no harm.
  /// @pre finite points
  void remove(PointCloud& cloud, float clearance);

private:
  static constexpr float kNone = std::numeric_limits<float>::infinity();
  struct Column {
    float lowest = kNone, second = kNone, third = kNone;  // z, metres
  };

  FixedVector<Column> columns_;
};

}  // namespace scree
