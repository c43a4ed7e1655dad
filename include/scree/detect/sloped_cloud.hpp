#pragma once

#include <cmath>

#include "scree/core/fixed_vector.hpp"
#include "scree/detect/elevation_gradient.hpp"
#include "scree/detect/plane_cells.hpp"

namespace scree {

/// A cloud in the cells of the plane, with the slope of the elevation at each of its sorted points
/// (metres per metre); NaN where it is not known.
struct SlopedCloud {
  PlaneCells cells;
  FixedVector<float> slope_x, slope_y;

  explicit SlopedCloud(std::size_t max_points)
      : cells(max_points), slope_x(max_points), slope_y(max_points) {}

  std::size_t size() const { return cells.size(); }
  const PointCloud& points() const { return cells.points(); }
  bool is_known(std::size_t i) const { return !std::isnan(slope_x[i]); }
  float square_slope(std::size_t i) const {
    return slope_x[i] * slope_x[i] + slope_y[i] * slope_y[i];
  }

  /// @pre the cells were built for gradient.reach()
  void compute(const ElevationGradient& gradient) {
    slope_x.resize(size());
    slope_y.resize(size());
    gradient.compute(cells, slope_x, slope_y);
  }
};

}  // namespace scree
