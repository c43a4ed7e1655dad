#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// Gives the unknown cells of a raster smooth heights that meet the known ones. Averages are pulled
/// up a pyramid and pushed down again (Gortler et al., The Lumigraph, SIGGRAPH 1996,
/// section 3.4.2). Each level is relaxed towards the mean of a cell's four neighbours, so that a
/// hole in a slope is spanned by the slope. Memory is taken once.
class RasterFill {
public:
  /// Smooths a level over a few cells; the coarser ones do the rest.
  static constexpr int kSteps = 12;
  /// Right to some centimetres.
  static constexpr int kRoughSteps = 3;

  explicit RasterFill(std::size_t max_cells);

  /// Fills a raster, given row by row.
  /// @param known for each cell whether its height is kept; 0: it is overwritten
  /// @param heights of the cells, metres; all become 0 where nothing at all is known
  /// @param steps of the relaxation on each level: more are smoother
  /// @pre columns * rows <= max_cells
  void fill(std::size_t columns, std::size_t rows, const std::uint8_t* known, float* heights,
            int steps = kSteps);

private:
  struct Level {
    std::size_t columns, rows;
    std::size_t first;  // place of its first cell in heights_ and weights_

    std::size_t at(std::size_t column, std::size_t row) const {
      return first + row * columns + column;
    }
  };

  void pull(const Level& fine, const Level& coarse);
  void push(const Level& coarse, const Level& fine);
  void relax(const Level& level, int steps);

  static constexpr std::size_t kMostLevels = 24;  // for rasters of up to 2^23 cells on a side
  FixedVector<Level> levels_;
  FixedVector<float> heights_, weights_;
  FixedVector<float> relaxed_;  // scratch: one row
};

}  // namespace scree
