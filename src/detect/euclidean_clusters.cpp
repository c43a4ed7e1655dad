#include "scree/detect/euclidean_clusters.hpp"

#include <algorithm>

#include "scree/detect/cell.hpp"
#include "scree/detect/supervoxels.hpp"

namespace scree {

EuclideanClusters::EuclideanClusters(std::size_t max_points)
    : sort_(max_points),
      keys_(max_points),
      cell_begin_(max_points + 1),
      parent_(max_points),
      labels_(max_points),
      label_of_root_(max_points) {}

std::uint32_t EuclideanClusters::root(std::uint32_t cell) {
  while (parent_[cell] != cell) cell = parent_[cell] = parent_[parent_[cell]];
  return cell;
}

void EuclideanClusters::join_cells(PointView points, float square, std::size_t a, std::size_t b) {
  const std::uint32_t root_a = root(static_cast<std::uint32_t>(a));
  const std::uint32_t root_b = root(static_cast<std::uint32_t>(b));
  if (root_a == root_b) return;
  for (std::uint32_t i = cell_begin_[a]; i < cell_begin_[a + 1]; ++i) {
    const std::uint32_t p = sort_.index(i);
    for (std::uint32_t j = cell_begin_[b]; j < cell_begin_[b + 1]; ++j) {
      const std::uint32_t q = sort_.index(j);
      const float dx = points.x[p] - points.x[q], dy = points.y[p] - points.y[q],
                  dz = points.z[p] - points.z[q];
      if (dx * dx + dy * dy + dz * dz > square) continue;
      parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
      return;
    }
  }
}

void EuclideanClusters::cluster(PointView points, float tolerance) {
  constexpr std::int64_t kReach = 2;  // cells: 2 x 0.577 of the tolerance is more than all of it
  const float inverse = 1.0F / cell_size(tolerance);
  CellRange columns, rows, layers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    columns.include(floor_to_cell(points.x[i] * inverse));
    rows.include(floor_to_cell(points.y[i] * inverse));
    layers.include(floor_to_cell(points.z[i] * inverse));
  }
  const auto wide_columns = static_cast<std::int64_t>(columns.count()) + 2 * kReach;
  const auto wide_layers = static_cast<std::int64_t>(layers.count()) + 2 * kReach;
  const auto key_at = [&](std::int64_t row, std::int64_t column, std::int64_t layer) {
    return static_cast<std::uint64_t>((row * wide_columns + column) * wide_layers + layer);
  };
  sort_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    sort_.push(key_at(floor_to_cell(points.y[i] * inverse) - std::int64_t{rows.low} + kReach,
                      floor_to_cell(points.x[i] * inverse) - std::int64_t{columns.low} + kReach,
                      floor_to_cell(points.z[i] * inverse) - std::int64_t{layers.low} + kReach),
               i);
  }
  sort_.sort();

  keys_.clear();
  cell_begin_.clear();
  for (std::size_t i = 0; i < sort_.size(); ++i) {
    if (!keys_.empty() && sort_.key(i) == keys_.back()) continue;
    keys_.push_back(sort_.key(i));
    cell_begin_.push_back(static_cast<std::uint32_t>(i));
  }
  cell_begin_.push_back(static_cast<std::uint32_t>(sort_.size()));

  const std::size_t cells = keys_.size();
  parent_.resize(cells);
  for (std::uint32_t cell = 0; cell < cells; ++cell) parent_[cell] = cell;
  // Half of the directions: each pair of cells is looked at once, by two cursors over the keys.
  for (std::int64_t row = 0; row <= kReach; ++row) {
    for (std::int64_t column = row == 0 ? 0 : -kReach; column <= kReach; ++column) {
      for (std::int64_t layer = row == 0 && column == 0 ? 1 : -kReach; layer <= kReach; ++layer) {
        const std::uint64_t offset = key_at(row, column, layer);
        std::size_t other = 0;
        for (std::size_t cell = 0; cell < cells; ++cell) {
          const std::uint64_t key = keys_[cell] + offset;
          while (other < cells && keys_[other] < key) ++other;
          if (other == cells) break;
          if (keys_[other] == key) join_cells(points, tolerance * tolerance, cell, other);
        }
      }
    }
  }

  labels_.resize(points.size());
  for (std::uint32_t cell = 0; cell < cells; ++cell) {
    for (std::uint32_t i = cell_begin_[cell]; i < cell_begin_[cell + 1]; ++i) {
      labels_[sort_.index(i)] = root(cell);
    }
  }
  label_of_root_.assign(cells, kNoLabel);
  count_ = 0;
  for (std::uint32_t& label : labels_) {
    std::uint32_t& number = label_of_root_[label];
    if (number == kNoLabel) number = static_cast<std::uint32_t>(count_++);
    label = number;
  }
}

}  // namespace scree
