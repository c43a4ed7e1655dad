#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/detect/ground_finder.hpp"

namespace scree {

struct GroundSurfaceSettings {
  float cell_size;    ///< edge of a cell of the raster, metres; more for a sparse or wide cloud
  float cell_points;  ///< least mean number of points in the cells that have any
  GroundFinderSettings finder;
};

/// A raster of a surface, in numbers that a loop can keep in registers.
struct LevelRaster {
  const float* heights;        ///< z in the middle of each cell, metres
  std::int32_t columns, rows;  ///< at least two of each
  float low_x, low_y;          ///< its corner, metres
  float inverse;               ///< cells a metre
};

/// The surface that the robot could drive on, under rocks and over holes: GroundFinder's, on a
/// raster of the heights of points. The paper has no such stage: its heights are above the
/// surroundings of a cluster, which tilts on slopes and between two tall rocks.
class GroundSurface {
public:
  GroundSurface(const GroundSurfaceSettings& settings, std::size_t max_points,
                std::size_t max_cells);

  /// @pre finite points, no more than max_points of them
  void build(PointView points);
  /// Builds a surface that is right to some centimetres, from cells twice as wide: a quarter as
  /// many. Of it only heights are known; the raster is that of build_below(). @pre as build()
  /// @param bounds that the raster has to hold: those of the points, or wider
  void build_roughly(PointView points, const PlaneBounds& bounds);
  /// Builds the surface of the same points. In loose cells the height is what was seen lowest
  /// instead of the median: below grass the ground goes on.
  /// @param loose for each cell of the raster whether it is loose; 0: it is not
  void build_below(std::span<const std::uint8_t> loose);

  /// Gives z of the surface of the last build, bilinear, metres. A place outside the raster has the
  /// height of the nearest cell.
  float height(float x, float y) const;
  /// Gives the heights of points above the surface, metres: `z - height(x, y)`.
  /// @param heights as many as points
  void heights_above(PointView points, std::span<float> heights) const;
  /// Calls visit(i, height above the surface) for each of the points, in their order.
  template <class Visit>
  void for_each_height(PointView points, Visit&& visit) const;

  // The raster, row by row, for stages that walk over it.
  bool is_ground(std::size_t cell) const { return finder_.is_ground(cell); }
  /// Distance of the height that was seen in a cell from the surface, metres. @pre is_ground(cell)
  float roughness(std::size_t cell) const { return std::abs(seen_[cell] - level(cell)); }
  /// Median height of the points in a cell, metres; NaN: not seen.
  float seen(std::size_t cell) const { return seen_[cell]; }
  /// z of the surface in the middle of a cell, metres.
  float level(std::size_t cell) const { return finder_.levels()[cell]; }
  /// z of the highest point in a cell, metres; minus infinity without one.
  float top(std::size_t cell) const { return top_[cell]; }
  /// Whether a cell lies in a crater whose flanks are gentle enough for ground.
  bool is_crater(std::size_t cell) const { return finder_.is_crater(cell); }
  /// Area of the smooth patch that a cell belongs to, square metres; 0: to none.
  float patch_area(std::size_t cell) const { return finder_.patch_area(cell); }
  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  float cell_size() const { return cell_; }
  std::size_t cell_at(float x, float y) const;
  /// The cell of a place that has neighbours; none for other places, and for what is no number.
  std::optional<std::size_t> inner_cell_at(float x, float y) const {
    const float u = column_of(x), v = row_of(y);
    const bool is_inner = u >= 1 && u < static_cast<float>(columns_ - 1) && v >= 1 &&
                          v < static_cast<float>(rows_ - 1);
    if (!is_inner) return {};
    return static_cast<std::size_t>(static_cast<std::int32_t>(v)) * columns_ +
           static_cast<std::size_t>(static_cast<std::int32_t>(u));
  }
  /// The cell of one of the points of the last build.
  std::size_t cell_of(std::size_t point) const { return cell_of_[point]; }
  bool covers(float x, float y) const {
    return column_of(x) >= 0 && column_of(x) < static_cast<float>(columns_) && row_of(y) >= 0 &&
           row_of(y) < static_cast<float>(rows_);
  }
  /// Whether a cell is none of the outermost, which hold no point.
  bool has_neighbours(std::size_t cell) const {
    const std::size_t column = cell % columns_, row = cell / columns_;
    return column > 0 && column + 1 < columns_ && row > 0 && row + 1 < rows_;
  }
  /// Middle of a column or a row, metres.
  float x_of(std::size_t column) const {
    return low_x_ + (static_cast<float>(column) + 0.5F) * cell_;
  }
  float y_of(std::size_t row) const { return low_y_ + (static_cast<float>(row) + 0.5F) * cell_; }
  /// Place on the raster in cells, from its edge; at least 2 cells lie beyond every point.
  float column_of(float x) const { return (x - low_x_) * inverse_; }
  float row_of(float y) const { return (y - low_y_) * inverse_; }
  /// Number of points in a cell; 0: not seen.
  std::uint32_t points_in(std::size_t cell) const { return begin_[cell + 1] - begin_[cell]; }

private:
  void lay_out(const PlaneBounds& bounds, float cell_size);
  /// The height below which this share of a cell's points lies; NaN without a point.
  float height_in(std::size_t cell, double share);
  /// Sorts the points by cells and sets the heights of these.
  /// @return the mean number of points in the cells that have any
  float gather(PointView points);
  void fill_raster(PointView points, const PlaneBounds& bounds);
  void find_ground();
  void halve();
  GroundRaster rough_raster() const { return {(columns_ + 1) / 2, (rows_ + 1) / 2, 2 * cell_}; }
  LevelRaster levels_of(const GroundFinder& finder, const GroundRaster& raster) const;

  GroundSurfaceSettings settings_;
  float cell_ = 1, inverse_ = 1, low_x_ = 0, low_y_ = 0;
  std::size_t columns_ = 0, rows_ = 0;
  FixedVector<std::uint32_t> begin_;    // where each cell's points begin in z_, and one more
  FixedVector<std::uint32_t> cell_of_;  // by point
  FixedVector<float> z_;                // z of the points, cell by cell
  FixedVector<float> seen_;             // height seen in each cell; NaN: no point
  FixedVector<float> top_;              // z of the highest point in each cell
  GroundFinder finder_;
  // The same from cells twice as wide.
  FixedVector<float> rough_seen_;
  GroundFinder rough_finder_;
  LevelRaster levels_{};  // of the last surface
};

inline std::size_t GroundSurface::cell_at(float x, float y) const {
  const auto index = [](float value, std::size_t count) {
    return static_cast<std::size_t>(
        static_cast<std::int32_t>(std::clamp(value, 0.0F, static_cast<float>(count - 1))));
  };
  return index((y - low_y_) * inverse_, rows_) * columns_ +
         index((x - low_x_) * inverse_, columns_);
}

template <class Visit>
void GroundSurface::for_each_height(PointView points, Visit&& visit) const {
  std::array<float, 256> heights;
  for (std::size_t first = 0; first < points.size(); first += heights.size()) {
    const std::size_t count = std::min(heights.size(), points.size() - first);
    heights_above(points.subview(first, count), std::span(heights).first(count));
    for (std::size_t i = 0; i < count; ++i) visit(first + i, heights[i]);
  }
}

inline float GroundSurface::height(float x, float y) const {
  const auto split = [](float value, std::int32_t count, float& share) {
    const float inside = std::clamp(value - 0.5F, 0.0F, static_cast<float>(count) - 1.001F);
    const auto index = static_cast<std::int32_t>(inside);
    share = inside - static_cast<float>(index);
    return std::ptrdiff_t{index};
  };
  float u = 0, v = 0;
  const std::ptrdiff_t column = split((x - low_x_) * levels_.inverse, levels_.columns, u);
  const std::ptrdiff_t row = split((y - low_y_) * levels_.inverse, levels_.rows, v);
  const float* const at = levels_.heights + row * levels_.columns + column;
  const float near = at[0] + u * (at[1] - at[0]);
  const float* const above = at + levels_.columns;
  const float far = above[0] + u * (above[1] - above[0]);
  return near + v * (far - near);
}

}  // namespace scree
