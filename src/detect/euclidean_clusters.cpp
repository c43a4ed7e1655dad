#include "scree/detect/euclidean_clusters.hpp"

#include <algorithm>
#include <limits>

#include "scree/detect/label.hpp"
#include "scree/detect/union_find.hpp"

namespace scree {

EuclideanClusters::EuclideanClusters(std::size_t max_points)
    : cells_(max_points),
      parent_(max_points),
      labels_(max_points),
      sizes_(max_points),
      label_of_root_(max_points) {}

void EuclideanClusters::join_cells(PointView points, float square, std::size_t a, std::size_t b) {
  const std::uint32_t root_a = root_of(parent_, static_cast<std::uint32_t>(a));
  const std::uint32_t root_b = root_of(parent_, static_cast<std::uint32_t>(b));
  if (root_a == root_b) return;
  const Run run_a = cells_.run(a), run_b = cells_.run(b);
  for (std::uint32_t i = run_a.begin; i < run_a.end; ++i) {
    const std::uint32_t p = cells_.source(i);
    for (std::uint32_t j = run_b.begin; j < run_b.end; ++j) {
      const std::uint32_t q = cells_.source(j);
      const float dx = points.x[p] - points.x[q], dy = points.y[p] - points.y[q],
                  dz = points.z[p] - points.z[q];
      if (dx * dx + dy * dy + dz * dz > square) continue;
      parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
      return;
    }
  }
}

void EuclideanClusters::cluster(PointView points, float tolerance) {
  // Cells of 0.577 of the tolerance: two of them reach further than all of it.
  constexpr int kReach = SpaceCells::kReach;
  cells_.build(points, cell_size(tolerance), std::numeric_limits<float>::infinity());
  const std::size_t cells = cells_.cells();
  parent_.resize(cells);
  for (std::uint32_t cell = 0; cell < cells; ++cell) parent_[cell] = cell;
  // Half of the directions: each pair of cells is looked at once.
  for (int row = 0; row <= kReach; ++row) {
    for (int column = row == 0 ? 0 : -kReach; column <= kReach; ++column) {
      for (int layer = row == 0 && column == 0 ? 1 : -kReach; layer <= kReach; ++layer) {
        cells_.for_each_pair(row, column, layer, [&](std::size_t cell, std::size_t other) {
          join_cells(points, tolerance * tolerance, cell, other);
        });
      }
    }
  }

  labels_.resize(points.size());
  for (std::uint32_t cell = 0; cell < cells; ++cell) {
    const Run run = cells_.run(cell);
    for (std::uint32_t i = run.begin; i < run.end; ++i)
      labels_[cells_.source(i)] = root_of(parent_, cell);
  }
  label_of_root_.assign(cells, kNoLabel);
  sizes_.clear();
  for (std::uint32_t& label : labels_) {
    std::uint32_t& number = label_of_root_[label];
    if (number == kNoLabel) {
      number = static_cast<std::uint32_t>(sizes_.size());
      sizes_.push_back(0);
    }
    label = number;
    ++sizes_[label];
  }
}

}  // namespace scree
