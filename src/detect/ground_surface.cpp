#include "scree/detect/ground_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scree/detect/multiversion.hpp"
#include "scree/detect/quantile.hpp"

namespace scree {
namespace {

constexpr std::size_t kBorder = 2;  // empty cells all around, so that every cell has neighbours

/// A place that is no number counts as the raster's edge.
SCREE_MULTIVERSION
void subtract_surface(const LevelRaster raster, const float* x, const float* y, const float* z,
                      std::size_t count, float* __restrict out) {
  const float last_u = static_cast<float>(raster.columns) - 1.001F;
  const float last_v = static_cast<float>(raster.rows) - 1.001F;
  for (std::size_t i = 0; i < count; ++i) {
    float u = (x[i] - raster.low_x) * raster.inverse - 0.5F;
    float v = (y[i] - raster.low_y) * raster.inverse - 0.5F;
    u = u > 0 ? u : 0;
    v = v > 0 ? v : 0;
    u = u < last_u ? u : last_u;
    v = v < last_v ? v : last_v;
    const auto column = static_cast<std::int32_t>(u), row = static_cast<std::int32_t>(v);
    const float share_u = u - static_cast<float>(column), share_v = v - static_cast<float>(row);
    const std::int32_t at = row * raster.columns + column, above = at + raster.columns;
    const float* const heights = raster.heights;
    const float near = heights[at] + share_u * (heights[at + 1] - heights[at]);
    const float far = heights[above] + share_u * (heights[above + 1] - heights[above]);
    out[i] = z[i] - (near + share_v * (far - near));
  }
}

}  // namespace

GroundSurface::GroundSurface(const GroundSurfaceSettings& settings, std::size_t max_points,
                             std::size_t max_cells)
    : settings_(settings),
      begin_(max_cells + 2),
      cell_of_(max_points),
      z_(max_points),
      seen_(max_cells),
      top_(max_cells),
      finder_(settings.finder, max_cells),
      // Half as many columns and rows, rounded up, of a raster that has at least five of each.
      rough_seen_(max_cells / 16 * 5 + 16),
      rough_finder_(settings.finder, rough_seen_.capacity()) {}

void GroundSurface::build(PointView points) {
  fill_raster(points, bounds_of(points));
  find_ground();
}

void GroundSurface::build_roughly(PointView points, const PlaneBounds& bounds) {
  fill_raster(points, bounds);
  halve();
  rough_finder_.find(rough_raster(), rough_seen_.data(), GroundFinder::Accuracy::rough);
  levels_ = levels_of(rough_finder_, rough_raster());
}

void GroundSurface::build_below(std::span<const std::uint8_t> loose) {
  constexpr double kLow = 0.05;  // share of a cell's points that is noise below the ground
  for (std::size_t cell = 0; cell < seen_.size(); ++cell) {
    if (loose[cell] != 0) seen_[cell] = height_in(cell, kLow);
  }
  find_ground();
}

void GroundSurface::find_ground() {
  const GroundRaster raster{columns_, rows_, cell_};
  finder_.find(raster, seen_.data(), GroundFinder::Accuracy::full);
  levels_ = levels_of(finder_, raster);
}

LevelRaster GroundSurface::levels_of(const GroundFinder& finder, const GroundRaster& raster) const {
  return {.heights = finder.levels(),
          .columns = static_cast<std::int32_t>(raster.columns),
          .rows = static_cast<std::int32_t>(raster.rows),
          .low_x = low_x_,
          .low_y = low_y_,
          .inverse = 1 / raster.cell_size};
}

void GroundSurface::fill_raster(PointView points, const PlaneBounds& bounds) {
  // Cells too small for the density of the points leave the ground in tatters.
  constexpr float kGrowth = 1.25F;
  constexpr int kMostGrowths = 8;  // up to six times the size
  float cell_size = settings_.cell_size;
  for (int growth = 0;; ++growth, cell_size *= kGrowth) {
    lay_out(bounds, cell_size);
    if (gather(points) >= settings_.cell_points || growth == kMostGrowths) break;
  }
}

/// Gives each cell of the rough raster the mean of what was seen in the four that lie in it.
/// Rounding may put a point one cell beyond its place, where the rough raster ends; it does not
/// count.
void GroundSurface::halve() {
  const auto [columns, rows, cell_size] = rough_raster();
  rough_seen_.assign(columns * rows, GroundFinder::kUnseen);
  for (std::size_t row = 1; row + 1 < rows; ++row) {
    for (std::size_t column = 1; column + 1 < columns; ++column) {
      float height = 0, count = 0;
      for (std::size_t v = 2 * row; v < 2 * row + 2; ++v) {
        for (std::size_t u = 2 * column; u < 2 * column + 2; ++u) {
          const float seen = seen_[v * columns_ + u];
          if (std::isnan(seen)) continue;
          height += seen;
          ++count;
        }
      }
      if (count > 0) rough_seen_[row * columns + column] = height / count;
    }
  }
}

void GroundSurface::lay_out(const PlaneBounds& bounds, float cell_size) {
  const auto cells = [&](float low, float high) {
    return static_cast<std::size_t>((high - low) / cell_) + 1 + 2 * kBorder;
  };
  for (cell_ = cell_size;; cell_ *= 2) {
    columns_ = cells(bounds.low_x, bounds.high_x);
    rows_ = cells(bounds.low_y, bounds.high_y);
    if (columns_ * rows_ <= seen_.capacity()) break;
  }
  inverse_ = 1 / cell_;
  low_x_ = bounds.low_x - static_cast<float>(kBorder) * cell_;
  low_y_ = bounds.low_y - static_cast<float>(kBorder) * cell_;
}

float GroundSurface::gather(PointView points) {
  const std::size_t cells = columns_ * rows_;
  // Counting sort: begin_[cell + 2] counts, then begin_[cell + 1] runs from each cell's first place
  // to its last.
  begin_.assign(cells + 2, 0);
  cell_of_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t cell = cell_at(points.x[i], points.y[i]);
    cell_of_[i] = static_cast<std::uint32_t>(cell);
    ++begin_[cell + 2];
  }
  for (std::size_t cell = 0; cell < cells; ++cell) begin_[cell + 2] += begin_[cell + 1];
  z_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    z_[begin_[cell_of_[i] + 1]++] = points.z[i];
  }
  seen_.resize(cells);
  top_.resize(cells);
  std::size_t occupied = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    seen_[cell] = height_in(cell, 0.5);
    top_[cell] = -std::numeric_limits<float>::infinity();
    if (points_in(cell) == 0) continue;
    ++occupied;
    top_[cell] = *std::max_element(z_.begin() + begin_[cell], z_.begin() + begin_[cell + 1]);
  }
  return static_cast<float>(points.size()) / static_cast<float>(std::max<std::size_t>(occupied, 1));
}

void GroundSurface::heights_above(PointView points, std::span<float> heights) const {
  subtract_surface(levels_, points.x.data(), points.y.data(), points.z.data(), points.size(),
                   heights.data());
}

float GroundSurface::height_in(std::size_t cell, double share) {
  const std::span<float> heights(z_.begin() + begin_[cell], points_in(cell));
  return heights.empty() ? GroundFinder::kUnseen : quantile(heights, share);
}

}  // namespace scree
