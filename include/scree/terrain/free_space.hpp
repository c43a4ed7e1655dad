#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"
#include "scree/terrain/toroidal_grid.hpp"

namespace scree {

/// A coarse grid of hits and misses around the robot: how many beams ended in a cell, how many went
/// through it, and when the last one did. Its memory is bounded by a ToroidalGrid; a slot belongs
/// to the cell that a beam came to last.
class FreeSpace {
public:
  static constexpr float kCell = 0.25F;  ///< edge, metres; the grid is 32 m wide and 8 m high

  FreeSpace() : cells_(Grid::kSlots) { clear(); }

  void clear() { cells_.assign(cells_.capacity(), {}); }
  /// Counts beams that went through the cell of a point.
  /// @param sweep its number, from 1 on
  void add_misses(const Eigen::Vector3f& point, std::uint32_t sweep, std::uint16_t beams);
  /// Counts a beam that ended in the cell of a point.
  void add_hit(const Eigen::Vector3f& point);
  /// The last sweep with a beam that went through the cell of a point; 0 for none.
  std::uint32_t last_miss(const Eigen::Vector3f& point) const;
  /// The share of hits among the last thousands of beams; 1 where no beam came.
  float hit_ratio(const Eigen::Vector3f& point) const;

private:
  using Grid = ToroidalGrid<128, 32>;

  struct Cell {
    Grid::CellIndex index;
    std::uint32_t last_miss = 0;  ///< sweep
    std::uint16_t hits = 0, misses = 0;
  };

  Cell& cell_for(const Eigen::Vector3f& point);
  /// Null where no beam came.
  const Cell* find(const Eigen::Vector3f& point) const;

  FixedVector<Cell> cells_;
};

}  // namespace scree
