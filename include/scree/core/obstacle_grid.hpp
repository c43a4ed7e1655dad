#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/pose.hpp"

namespace scree {

/// What is known of the ground in a cell.
enum class CellState : std::uint8_t {
  unknown,   ///< not seen, or what was seen there is in doubt
  free,      ///< ground was seen, and nothing on it
  occupied,  ///< a positive obstacle was published there
  drop       ///< a negative one
};
inline constexpr std::size_t kCellStates = 4;

/// The ground around the robot in square cells, which lie row by row: x grows along a row, y from
/// row to row. Its edges lie on whole cells of `odom`, so a place stays in its cell while the robot
/// drives. Memory is taken once, for the largest one.
struct ObstacleGrid {
  static constexpr std::size_t kMostCells = 128;  ///< on a side: it fits in one datagram
  static constexpr std::int16_t kNoGround = std::numeric_limits<std::int16_t>::min();

  std::int64_t stamp_ns = 0;  ///< of the data, as that of the list
  Pose pose;                  ///< `base` in `odom` at stamp_ns
  Eigen::Vector2d origin =
      Eigen::Vector2d::Zero();  ///< its corner of least x and y in `odom`, metres
  double cell_size = 0;         ///< metres
  std::size_t columns = 0, rows = 0;
  FixedVector<CellState> state{kMostCells * kMostCells};
  /// Height of the ground above `base`, hundredths of a metre; kNoGround of an unknown cell. In an
  /// occupied one and in a drop it is that of the ground around it.
  FixedVector<std::int16_t> ground{kMostCells * kMostCells};

  bool empty() const { return columns == 0; }
  std::size_t cells() const { return columns * rows; }
  /// Middle of a cell in `odom`, metres.
  Eigen::Vector2d middle(std::size_t column, std::size_t row) const {
    return origin + cell_size * Eigen::Vector2d(static_cast<double>(column) + 0.5,
                                                static_cast<double>(row) + 0.5);
  }

  /// Nothing is known, of no cell.
  void clear() {
    columns = rows = 0;
    state.clear();
    ground.clear();
  }
  /// Allocates nothing.
  void copy_from(const ObstacleGrid& from) {
    stamp_ns = from.stamp_ns;
    pose = from.pose;
    origin = from.origin;
    cell_size = from.cell_size;
    columns = from.columns;
    rows = from.rows;
    state.copy_from(from.state);
    ground.copy_from(from.ground);
  }
};

}  // namespace scree
