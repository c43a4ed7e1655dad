#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/pose.hpp"
#include "scree/motion/deskew.hpp"
#include "scree/terrain/free_space.hpp"

namespace scree {

/// Finds the points of a sweep that are on things that move: those in cells that were clear before,
/// where enough of them stand together, and what else stands above or below them.
class MovingPoints {
public:
  explicit MovingPoints(std::size_t max_points);

  /// Sets the marks of a sweep.
  /// @param pose `base` in the map's frame at the sweep's end
  /// @param free_space as it was before the sweep, in the map's frame
  /// @param reach metres from `base`; what lies farther off is not looked at
  void find(DeskewedSweep& sweep, const Pose& pose, const FreeSpace& free_space, float reach);

  /// How many things were found.
  std::size_t size() const { return begin_.empty() ? 0 : begin_.size() - 1; }
  /// The points of one of them that lie in clear cells, as indices into the sweep.
  std::span<const std::uint32_t> members(std::size_t thing) const {
    return {members_.data() + begin_[thing], begin_[thing + 1] - begin_[thing]};
  }

private:
  /// The cell of a place in `base`, or kNone outside.
  std::size_t cell_of(float x, float y) const;
  template <class Visit>
  static void for_each_beside(std::size_t cell, Visit visit) {
    for (const std::size_t row : {cell - kCells, cell, cell + kCells}) {
      for (const std::size_t beside : {row - 1, row, row + 1}) {
        if (beside != cell) visit(beside);
      }
    }
  }
  bool seed(const DeskewedSweep& sweep, const Pose& pose, const FreeSpace& free_space, float reach);
  bool stands_up(std::size_t cell) const;
  void collect(std::size_t start);
  bool is_solid(const DeskewedSweep& sweep, std::span<const std::uint32_t> members) const;
  void mark(DeskewedSweep& sweep) const;

  static constexpr float kCell = 0.2F;        // metres
  static constexpr std::size_t kCells = 160;  // a side
  static constexpr std::size_t kNone = kCells * kCells;

  FixedVector<std::uint32_t> first_, next_;  // of the points in each cell, linked
  FixedVector<float> low_, high_;            // z of the points in each cell
  FixedVector<std::uint8_t> state_;          // of each cell
  FixedVector<std::uint32_t> queue_;
  FixedVector<std::uint32_t> members_, begin_;
};

}  // namespace scree
