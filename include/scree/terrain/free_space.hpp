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
///
/// A cell is clear when several sweeps went through it, nothing was ever hit in it or right beside
/// it, and that has been known before the last hit: what is hit in a clear cell has moved there. It
/// stays clear while something passes, and is no longer when something stays (ever-free voxels:
/// Schmid et al., Dynablox, RA-L 2023).
class FreeSpace {
public:
  static constexpr float kCell = 0.25F;  ///< edge, metres; the grid is 32 m wide and 8 m high
  /// Metres around the robot within which beams are counted: where obstacles are searched for, and
  /// some way on, so that it is known by then what is clear.
  static constexpr float kReach = 15;

  FreeSpace() : cells_(Grid::kSlots) { clear(); }

  void clear() { cells_.assign(cells_.capacity(), {}); }
  /// Counts beams that went through the cell of a point.
  /// @param sweep its number, from 1 on
  void add_misses(const Eigen::Vector3f& point, std::uint32_t sweep, std::uint16_t beams);
  /// Counts beams that went along a line through the cells of places on it, a cell's edge apart.
  /// @param along of length one
  /// @param end of the line, metres from its beginning
  void add_beams(const Eigen::Vector3f& from, const Eigen::Vector3f& along, float end,
                 std::uint32_t sweep, std::uint16_t beams);
  /// Counts a beam that ended in the cell of a point.
  /// @param sweep its number, from 1 on
  void add_hit(const Eigen::Vector3f& point, std::uint32_t sweep);
  /// The last sweep with a beam that went through the cell of a point; 0 for none.
  std::uint32_t last_miss(const Eigen::Vector3f& point) const;
  /// The share of hits among the last thousands of beams; 1 where no beam came.
  float hit_ratio(const Eigen::Vector3f& point) const;
  /// Whether nearly all of the last thousands of beams went through the cell of a point, and
  /// nothing beside it stops more.
  /// @param look number of the walk over the map: each cell is looked at once in it
  bool is_nearly_empty(const Eigen::Vector3f& point, std::uint32_t look);
  bool is_clear(const Eigen::Vector3f& point) const;
  enum class Presence : std::uint8_t { unknown, there, gone };
  /// Whether what was seen in the cell of a point still is: hit in one of the last three sweeps
  /// (there), or gone through in one of them and not hit (gone).
  Presence presence(const Eigen::Vector3f& point, std::uint32_t sweep) const;
  /// Whether a beam of this sweep or the one before went through the cell of a point, and none
  /// ended there.
  bool is_seen_through(const Eigen::Vector3f& point, std::uint32_t sweep) const;

private:
  using Grid = ToroidalGrid<kGridAcross, kGridUp>;

  struct Cell {
    Grid::CellIndex index;
    std::uint32_t last_miss = 0, last_hit = 0;  ///< sweeps
    std::uint16_t hits = 0, misses = 0;
    std::uint8_t passes = 0;  ///< sweeps that went through it since it was hit, saturating
    std::uint8_t stays = 0;   ///< sweeps with hits and none without between, saturating
    bool is_clear = false;
    bool is_nearly_empty = false;  ///< at the last look
    std::uint32_t look = 0;
  };

  Cell& cell_for(const Eigen::Vector3f& point);
  /// Null where no beam came.
  const Cell* find(const Eigen::Vector3f& point) const;
  const Cell* find(const Grid::CellIndex& index) const;
  bool stops_little(const Eigen::Vector3f& point) const;
  bool has_empty_neighbours(const Grid::CellIndex& index) const;
  void disturb_neighbours(const Grid::CellIndex& index);

  FixedVector<Cell> cells_;
};

}  // namespace scree
