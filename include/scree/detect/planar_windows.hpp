#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// A square of a raster whose known heights lie on a plane.
struct PlanarWindow {
  std::uint32_t column, row;    ///< of its lowest cell
  std::uint32_t columns, rows;  ///< its cells; fewer at the edge of the raster
  float height;                 ///< of the plane in its lowest cell, metres
  float rise_x, rise_y;         ///< metres a cell

  float plane_at(std::size_t at_column, std::size_t at_row) const {
    return height + rise_x * (static_cast<float>(at_column) - static_cast<float>(column)) +
           rise_y * (static_cast<float>(at_row) - static_cast<float>(row));
  }
};

/// Finds planes in a raster of heights at several scales. A sparse cloud has gaps between its
/// points, so that a cell has no neighbours to take its slope from; over a wider square the points
/// still tell whether they lie on a plane. Leaves and blades lie on none. Memory is taken once.
class PlanarWindows {
public:
  explicit PlanarWindows(std::size_t max_cells);

  /// @param heights of the raster's cells, row by row, metres; NaN: not known
  /// @param max_slope of a window, metres per metre; the widest windows may be as steep as a bank
  void find(std::size_t columns, std::size_t rows, const float* heights, float cell_size,
            float max_slope);

  /// The windows that were found, small ones first.
  std::span<const PlanarWindow> all() const { return {windows_.data(), windows_.size()}; }

  /// Calls visit(cell, off) for the known cells of a window, with their distance from its plane.
  template <class Visit>
  static void for_each_cell(const PlanarWindow& window, std::size_t columns, const float* heights,
                            Visit&& visit) {
    for (std::size_t row = window.row; row < window.row + window.rows; ++row) {
      for (std::size_t column = window.column; column < window.column + window.columns; ++column) {
        const std::size_t cell = row * columns + column;
        if (!std::isnan(heights[cell])) visit(cell, heights[cell] - window.plane_at(column, row));
      }
    }
  }

  /// A cell that lies farther than this from a window's plane does not belong to it, metres.
  static constexpr float kThickness = 0.03F;

private:
  struct Moments {
    float count = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;

    void add(float px, float py, float pz);
    /// Adds moments whose axes begin at (dx, dy).
    void add(const Moments& other, float dx, float dy);
  };

  void gather(std::size_t half);
  void fit(std::size_t column, std::size_t row, std::size_t half, float cell_size, float max_slope);
  bool is_flat(const PlanarWindow& window) const;

  std::size_t columns_ = 0, rows_ = 0, blocks_across_ = 0;
  const float* heights_ = nullptr;
  FixedVector<Moments> blocks_;  // of half a window's side
  FixedVector<PlanarWindow> windows_;
};

}  // namespace scree
