#pragma once

#include <cstddef>
#include <cstdint>

#include "scree/core/floor_to_cell.hpp"
#include "scree/detect/key_sort.hpp"

namespace scree {

/// Metres from the origin, either way, within which the cells of an axis can be told apart when
/// `axes` of them share a 64-bit word with the index of one of `capacity` points.
/// @note With 2^20 points three axes reach 8184 cells, 484 m at the paper's leaf of 0.0592 m.
inline float reach_of_cells(float cell_size, std::size_t capacity, int axes) {
  const int bits = KeySort::key_bits(capacity) / axes;
  const std::int32_t cells = std::int32_t{1} << (bits < 31 ? bits - 1 : 30);
  constexpr std::int32_t kWidening = 8;  // neighbourhoods look past the outermost cells
  return static_cast<float>(cells - kWidening) * cell_size;
}

/// Smallest and largest cell on one axis.
struct CellRange {
  std::int32_t low = INT32_MAX, high = INT32_MIN;

  void include(std::int32_t cell) {
    low = cell < low ? cell : low;
    high = cell > high ? cell : high;
  }
  std::uint64_t count() const {
    return low > high ? 0 : static_cast<std::uint64_t>(std::int64_t{high} - low + 1);
  }
  std::uint64_t offset(std::int32_t cell) const {
    return static_cast<std::uint64_t>(std::int64_t{cell} - low);
  }
};

}  // namespace scree
