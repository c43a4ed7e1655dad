#pragma once

#include <array>
#include <cstddef>

namespace scree {

/// Number of neighbours to the sides of a cell; they come first, the others lie at its corners.
inline constexpr std::size_t kSides = 4;

/// The neighbours of a cell of a raster: to its four sides, then at its four corners.
/// @pre the cell is none of the raster's outermost, which hold no point
inline std::array<std::size_t, 8> neighbours(std::size_t cell, std::size_t columns) {
  return {cell - 1,           cell + 1,           cell - columns,     cell + columns,
          cell - columns - 1, cell - columns + 1, cell + columns - 1, cell + columns + 1};
}

}  // namespace scree
