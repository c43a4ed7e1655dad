#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "scree/core/floor_to_cell.hpp"

namespace scree {

/// Cubic cells in a box that repeats endlessly in all directions: many places share a cell, which
/// belongs to the one that was last taken, told apart by its numbers.
template <int kWide, int kHigh>
struct EndlessBox {
  static_assert((kWide & (kWide - 1)) == 0 && (kHigh & (kHigh - 1)) == 0, "powers of two");
  static constexpr std::size_t kCells = std::size_t{kWide} * kWide * kHigh;

  /// A cell's number along each axis.
  struct Place {
    std::int32_t x = 0, y = 0, z = 0;
    bool operator==(const Place&) const = default;

    /// Of its cell in the box, below kCells.
    std::size_t index() const {
      return (wrapped(z, kHigh) * kWide + wrapped(y, kWide)) * kWide + wrapped(x, kWide);
    }
  };

  /// @param inverse cells a metre
  static Place place(const Eigen::Vector3f& point, float inverse) {
    return {floor_to_cell(point.x() * inverse), floor_to_cell(point.y() * inverse),
            floor_to_cell(point.z() * inverse)};
  }

private:
  static std::size_t wrapped(std::int32_t value, int size) {
    return static_cast<std::size_t>(value & (size - 1));
  }
};

}  // namespace scree
