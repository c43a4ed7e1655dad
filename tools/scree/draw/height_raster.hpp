#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "scree/core/obstacle_grid.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/core/pose.hpp"

namespace scree::cli {

/// Heights in square cells that lie row by row: x grows along a row, y from row to row.
struct HeightGrid {
  double x = 0, y = 0;  ///< corner where both are least, metres
  double cell = 0;      ///< edge of a cell, metres
  std::size_t columns = 0, rows = 0;
  std::vector<float> heights;  ///< metres; NaN: unknown

  float& at(std::size_t column, std::size_t row) { return heights[row * columns + column]; }
  float at(std::size_t column, std::size_t row) const { return heights[row * columns + column]; }
};

/// The ground's height in square cells of a plane, gathered from clouds one after the other. What
/// is seen again takes the place of what was seen before.
class HeightRaster {
public:
  /// @param cell edge, metres
  explicit HeightRaster(double cell) : cell_(cell) {}

  /// A cell takes the mean of its points, less what hangs higher than 2 m above its lowest one.
  /// Points that are no numbers are passed over.
  /// @param frame of the points, in that of the raster
  void add(const PointView& points, const Pose& frame);
  /// A cell takes the ground of the grid's cell that has its middle, without what stands on it. A
  /// raster that is still empty takes the grid's cells.
  void add(const ObstacleGrid& grid);

  /// All that was gathered. Where that would be more than `most_cells`, cells of twice the edge
  /// stand for four, and so on. Of no cell, nothing.
  HeightGrid grid(std::size_t most_cells) const;

private:
  double cell_;
  std::unordered_map<std::int64_t, float> cells_;
};

/// Gives cells that are not known, but have neighbours that are, their mean; so many times.
void fill_gaps(HeightGrid& grid, int times);

/// How bright each cell is, 0 to 1, lit from the upper left where x is up and y to the left. What
/// lies deeper than the ground within a metre around it is darker, what is higher brighter, so that
/// holes and edges show on every side. NaN: unknown.
std::vector<float> hillshade(const HeightGrid& grid);

}  // namespace scree::cli
