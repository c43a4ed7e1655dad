#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// Gives the unknown cells of a raster smooth heights that meet the known ones: averages are pulled
/// up a pyramid and pushed down again (Gortler et al., The Lumigraph, SIGGRAPH 1996,
/// section 3.4.2), and each level is relaxed towards the mean of its four neighbours, so that a
/// hole in a slope is spanned by the slope. Memory is taken once.
class RasterFill {
public:
  explicit RasterFill(std::size_t max_cells);

  /// @param known not zero where `heights` is to be kept; other heights are overwritten (0 where
  /// nothing at all is known). Row by row, `columns` a row.
  /// @pre columns * rows <= max_cells
  void fill(std::size_t columns, std::size_t rows, const std::uint8_t* known, float* heights);

private:
  struct Level {
    std::size_t columns, rows, first;  // first: place of its cells in heights_ and weights_

    std::size_t at(std::size_t column, std::size_t row) const {
      return first + row * columns + column;
    }
  };

  void pull(const Level& fine, const Level& coarse);
  void push(const Level& coarse, const Level& fine);
  void relax(const Level& level);

  static constexpr std::size_t kMostLevels = 24;
  FixedVector<Level> levels_;
  FixedVector<float> heights_, weights_;
  FixedVector<float> relaxed_;  // a row
};

}  // namespace scree
