#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"
#include "scree/terrain/toroidal_grid.hpp"

namespace scree {

/// A patch of the ground: the plane through the points of one cell.
struct Surfel {
  Eigen::Vector3f center = Eigen::Vector3f::Zero();   ///< the map's frame, metres
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< upwards
  float thickness = 0;  ///< standard deviation of the points about the plane, metres
  float width = 0;      ///< standard deviation in the plane's narrower direction, metres
  float points = 0;
};

/// The ground around the robot as planes in cubic cells, for registration. Its memory is bounded. A
/// slot of its ToroidalGrid belongs to the cell that was seen last, so that what the robot leaves
/// behind goes; where there is no more room, what was seen first makes some. Planes of many points
/// hardly move any more: sweeps are laid onto the ground as it was first seen.
/// @note Points are floats in the map's frame: good to 1 mm as far as 8 km from its origin, to 1 cm
/// as far as 80 km.
class SurfelMap {
public:
  /// @param cell edge, metres
  /// @param width, height of the grid in cells, powers of two: 38 m x 38 m x 19 m at cells of 0.3
  /// m. It has room for twice the cells of dense ground as wide.
  explicit SurfelMap(float cell, int width = 128, int height = 64);

  void add(const Eigen::Vector3f& point);

  /// The plane of the cell at a point; null where there is none, or too few or no spread-out
  /// points.
  const Surfel* at(const Eigen::Vector3f& point);
  void clear();

private:
  using Grid = ToroidalGrid<128, 64>;

  struct Cell {
    Grid::CellIndex index;
    bool is_used = false;
    bool is_fresh = false;  // the surfel is that of the sums
    bool is_plane = false;
    std::uint8_t left_out = 0;  // points, since the plane settled; wraps
    float points = 0;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();  // from the cell's middle
    float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
    Surfel surfel;
  };
  Eigen::Vector3f middle(const Cell& cell) const;
  void fit(Cell& cell) const;

  std::size_t slot(const Grid::CellIndex& index) const;
  /// Null where there is none.
  Cell* find(const Grid::CellIndex& index);
  Cell& find_or_add(const Grid::CellIndex& index);

  float cell_, inverse_;
  int width_, height_;
  FixedVector<std::uint32_t> numbers_;  // by slot: the cell's place plus one, 0 is free
  FixedVector<Cell> cells_;             // in a ring
  std::size_t next_ = 0;
};

}  // namespace scree
