#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "scree/core/floor_to_cell.hpp"

namespace scree {

/// Cells across and up of the grids around the robot. The fuzz targets make them anew in each run,
/// and have small ones.
#ifndef SCREE_GRID_ACROSS
#define SCREE_GRID_ACROSS 128
#endif
inline constexpr int kGridAcross = SCREE_GRID_ACROSS, kGridUp = kGridAcross / 4;

/// A grid of cubic cells whose storage wraps around in all three directions. Cells that lie a
/// multiple of the grid's size apart share a slot of memory; the user keeps the CellIndex there and
/// so tells which one the slot holds.
template <int kWidth, int kHeight>
struct ToroidalGrid {
  static_assert(kWidth >= 4 && kHeight >= 4);
  static_assert((kWidth & (kWidth - 1)) == 0 && (kHeight & (kHeight - 1)) == 0, "powers of two");
  static constexpr std::size_t kSlots = std::size_t{kWidth} * kWidth * kHeight;

  /// A cell's number along each axis, unbounded.
  struct CellIndex {
    std::int32_t x = 0, y = 0, z = 0;
    bool operator==(const CellIndex&) const = default;

    /// Where its memory lies, below kSlots. Cubes of 4 x 4 x 4 cells lie together: who comes to one
    /// cell comes to those around it.
    std::size_t slot() const {
      constexpr int kAcross = kWidth / kCube;
      const std::size_t cube =
          (wrapped(z >> 2, kHeight / kCube) * kAcross + wrapped(y >> 2, kAcross)) * kAcross +
          wrapped(x >> 2, kAcross);
      const std::size_t inside =
          (wrapped(z, kCube) * kCube + wrapped(y, kCube)) * kCube + wrapped(x, kCube);
      return cube * kInCube + inside;
    }
  };

  /// @param inverse_size cells a metre
  static CellIndex index_of(const Eigen::Vector3f& point, float inverse_size) {
    return {floor_to_cell(point.x() * inverse_size), floor_to_cell(point.y() * inverse_size),
            floor_to_cell(point.z() * inverse_size)};
  }

private:
  static constexpr int kCube = 4;  // edge
  static constexpr std::size_t kInCube = std::size_t{kCube} * kCube * kCube;

  static std::size_t wrapped(std::int32_t value, int size) {
    return static_cast<std::size_t>(value & (size - 1));
  }
};

}  // namespace scree
