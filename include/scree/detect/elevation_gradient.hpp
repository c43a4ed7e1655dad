#pragma once

#include <limits>
#include <span>

#include "scree/config/settings.hpp"
#include "scree/detect/plane_cells.hpp"

namespace scree {

struct Slope {
  float x = std::numeric_limits<float>::quiet_NaN();  ///< metres per metre; NaN: not known
  float y = std::numeric_limits<float>::quiet_NaN();
};

/// Gaussian-kernel Sobel operator on scattered points (paper eq. 1-4, fig. 2-3).
struct ElevationGradient {
  float spacing;       ///< d: distance of the eight positions around a point, metres
  float radius;        ///< r: reach of the kernel at each position, metres
  float bandwidth;     ///< standard deviation of the kernel, metres; the paper prints 2r
  int min_neighbours;  ///< least points within `radius` of each position

  /// How far from a point its neighbours matter; give it to PlaneCells::build().
  float reach() const { return spacing + radius; }

  /// Writes for every sorted point of `cells` the slope of the elevation along x and y (metres per
  /// metre). Both are NaN where one of the eight positions has too few neighbours: not known is not
  /// zero.
  void compute(const PlaneCells& cells, std::span<float> slope_x, std::span<float> slope_y) const;
};

inline ElevationGradient gradient_of(const KernelSettings& kernel) {
  return {.spacing = static_cast<float>(kernel.spacing),
          .radius = static_cast<float>(kernel.radius),
          .bandwidth = static_cast<float>(kernel.bandwidth * kernel.radius),
          .min_neighbours = kernel.neighbours};
}

}  // namespace scree
