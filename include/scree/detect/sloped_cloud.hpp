#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "scree/config/settings.hpp"
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

  /// @param wanted as ElevationGradient::compute() has it
  /// @pre the cells were built for gradient.reach()
  void compute(const ElevationGradient& gradient, std::span<const std::uint8_t> wanted) {
    slope_x.resize(size());
    slope_y.resize(size());
    gradient.compute(cells, wanted, slope_x, slope_y);
  }
};

/// @param shared_within metres, see ElevationGradient
inline ElevationGradient gradient_of(const KernelSettings& kernel, double shared_within = 0) {
  return {.spacing = static_cast<float>(kernel.spacing),
          .radius = static_cast<float>(kernel.radius),
          .bandwidth = static_cast<float>(kernel.bandwidth * kernel.radius),
          .min_neighbours = kernel.neighbours,
          .shared_within = static_cast<float>(shared_within)};
}

}  // namespace scree
