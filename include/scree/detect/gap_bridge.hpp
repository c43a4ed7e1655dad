#pragma once

#include <cstdint>
#include <span>

#include "scree/core/fixed_vector.hpp"
#include "scree/detect/edge_points.hpp"
#include "scree/detect/ground_surface.hpp"

namespace scree {

/// Joins clusters on the same side of the ground when they lie close together and no ground was
/// seen between them: a rock throws a shadow on its own top and back, and a few beams beyond it hit
/// again. Clusters with ground between them stay apart.
class GapBridge {
public:
  GapBridge(std::size_t max_cells, std::size_t max_points)
      : cluster_(max_cells), ground_seen_(max_cells), parent_(max_points) {}

  /// @param heights of the cloud's points above the surface
  /// @param edges the clusters' points
  /// @param labels of these points, from 0 without gaps; replaced
  /// @param gap longest distance bridged, metres
  /// @return how many clusters there are now
  std::size_t join(PointView cloud, std::span<const float> heights, const EdgePoints& edges,
                   std::span<std::uint32_t> labels, const GroundSurface& surface, float gap);

private:
  std::uint32_t root(std::uint32_t label);
  bool is_open(std::size_t from, std::ptrdiff_t columns, std::ptrdiff_t rows,
               const GroundSurface& surface) const;
  void join_neighbours(std::size_t cell, std::ptrdiff_t reach, const GroundSurface& surface);

  FixedVector<std::uint32_t> cluster_;  // twice a label plus side plus one; 0 where there is none
  FixedVector<std::uint8_t> ground_seen_;
  FixedVector<std::uint32_t> parent_;
};

}  // namespace scree
