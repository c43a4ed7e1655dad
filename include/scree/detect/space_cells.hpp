#pragma once

#include <cstdint>

#include "scree/core/point_cloud.hpp"
#include "scree/detect/cell.hpp"
#include "scree/detect/key_sort.hpp"

namespace scree {

/// Points [begin, end) of a sorted cloud.
struct Run {
  std::uint32_t begin, end;
};

/// Points sorted into cubic cells anchored at the origin. The key of a cell's neighbour is its own
/// plus a constant, so two cursors over the ascending keys find all pairs of neighbours.
class SpaceCells {
public:
  /// How many cells away a neighbour may be.
  static constexpr int kReach = 2;

  explicit SpaceCells(std::size_t max_points);

  /// Leaves out points that are not finite or lie `limit` metres or more from the origin on an
  /// axis.
  /// @pre limit <= reach_of_cells(cell_size, max_points, 3), no more than max_points points
  void build(PointView points, float cell_size, float limit);

  /// Number of points that were taken.
  std::size_t size() const { return sort_.size(); }
  /// Number of occupied cells. They are in order row by row, then column by column, then upwards.
  std::size_t cells() const { return keys_.size(); }
  /// The sorted points of a cell.
  Run run(std::size_t cell) const { return {begin_[cell], begin_[cell + 1]}; }
  /// Index in the cloud given to build() of a sorted point; ascending within a cell.
  std::uint32_t source(std::size_t sorted) const { return sort_.index(sorted); }

  /// Calls visit(cell, other) for each pair of occupied cells that lie so many rows, columns and
  /// layers apart. @pre none beyond kReach either way
  template <class Visit>
  void for_each_pair(int rows, int columns, int layers, Visit&& visit) const;

  /// Calls visit(index in the cloud) for the points of the 27 cells about a position, which must
  /// lie in an occupied cell or next to one.
  template <class Visit>
  void for_each_near(float x, float y, float z, Visit&& visit) const;

private:
  std::uint64_t key_at(float x, float y, float z) const {
    const std::uint64_t row = row_range_.offset(floor_to_cell(y * inverse_)) + kReach;
    const std::uint64_t column = column_range_.offset(floor_to_cell(x * inverse_)) + kReach;
    const std::uint64_t layer = layer_range_.offset(floor_to_cell(z * inverse_)) + kReach;
    return (row * columns_ + column) * layers_ + layer;
  }
  /// What is added to a key to get that of a neighbour; wraps round as unsigned numbers do.
  std::uint64_t step(int rows, int columns, int layers) const {
    const auto wide = [](int value) { return static_cast<std::uint64_t>(std::int64_t{value}); };
    return (wide(rows) * columns_ + wide(columns)) * layers_ + wide(layers);
  }
  std::size_t first_not_below(std::uint64_t key) const;

  float inverse_ = 1;
  CellRange row_range_, column_range_, layer_range_;
  std::uint64_t columns_ = 0, layers_ = 0;  // of a space with kReach empty cells more all around
  KeySort sort_;
  FixedVector<std::uint64_t> keys_;   // of the occupied cells, ascending
  FixedVector<std::uint32_t> begin_;  // first sorted point of each, and one past the last
};

template <class Visit>
void SpaceCells::for_each_pair(int rows, int columns, int layers, Visit&& visit) const {
  const std::uint64_t offset = step(rows, columns, layers);
  std::size_t other = 0;
  for (std::size_t cell = 0; cell < keys_.size(); ++cell) {
    const std::uint64_t key = keys_[cell] + offset;
    while (other < keys_.size() && keys_[other] < key) ++other;
    if (other == keys_.size()) return;
    if (keys_[other] == key) visit(cell, other);
  }
}

template <class Visit>
void SpaceCells::for_each_near(float x, float y, float z, Visit&& visit) const {
  const std::uint64_t middle = key_at(x, y, z);
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      // The three layers of a column are neighbours in the order of keys.
      const std::uint64_t last = middle + step(row, column, 1);
      for (std::size_t cell = first_not_below(middle + step(row, column, -1));
           cell < keys_.size() && keys_[cell] <= last; ++cell) {
        for (std::uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i) visit(source(i));
      }
    }
  }
}

}  // namespace scree
