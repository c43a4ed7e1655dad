#pragma once

#include <cstdint>
#include <span>

#include "scree/core/point_cloud.hpp"
#include "scree/detect/space_cells.hpp"

namespace scree {

/// Euclidean clustering on a grid (the result is that of paper algorithm 1): points closer than a
/// tolerance belong together, and so does whatever a chain of such points joins.
class EuclideanClusters {
public:
  explicit EuclideanClusters(std::size_t max_points);

  /// Edge of the cells: points that share one are always within the tolerance.
  static float cell_size(float tolerance) { return tolerance * 0.577F; }

  /// @pre points finite and within reach_of_cells(cell_size(tolerance), max_points, 3), no more
  /// than max_points of them
  void cluster(PointView points, float tolerance);

  /// Cluster of each point, numbered from 0 in the order of their first points.
  std::span<const std::uint32_t> labels() const { return labels_; }
  /// Points of each cluster.
  std::span<const std::uint32_t> sizes() const { return sizes_; }

private:
  void join_cells(PointView points, float square, std::size_t a, std::size_t b);

  SpaceCells cells_;
  FixedVector<std::uint32_t> parent_;  // union-find over the occupied cells
  FixedVector<std::uint32_t> labels_, sizes_;
  FixedVector<std::uint32_t> label_of_root_;
};

}  // namespace scree
