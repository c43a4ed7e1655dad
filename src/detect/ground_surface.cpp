#include "scree/detect/ground_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "scree/detect/label.hpp"
#include "scree/detect/multiversion.hpp"
#include "scree/detect/neighbours.hpp"
#include "scree/detect/quantile.hpp"
#include "scree/detect/union_find.hpp"

namespace scree {
namespace {

constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kBorder = 2;  // empty cells all around, so that every cell has neighbours

/// The raster of a surface, for loops that read registers only.
struct SurfaceRaster {
  const float* heights;
  std::int32_t columns, rows;
  float low_x, low_y, inverse;
};

/// A place that is no number counts as the raster's edge.
SCREE_MULTIVERSION
void subtract_surface(const SurfaceRaster raster, const float* x, const float* y, const float* z,
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

GroundSurface::GroundSurface(std::size_t max_points, std::size_t max_cells)
    : begin_(max_cells + 2),
      cell_of_(max_points),
      z_(max_points),
      seen_(max_cells),
      top_(max_cells),
      smooth_(max_cells),
      ground_(max_cells),
      patch_(max_cells),
      queue_(max_cells),
      patches_(max_cells),
      windows_(max_cells),
      trend_(max_cells),
      fill_(max_cells),
      depressions_(max_cells) {}

void GroundSurface::build(PointView points, const GroundSurfaceSettings& settings,
                          Accuracy accuracy) {
  // Cells too small for the density of the points leave the ground in tatters.
  constexpr float kGrowth = 1.25F;
  constexpr int kMostGrowths = 8;  // up to six times the size
  const PlaneBounds bounds = bounds_of(points);
  float cell_size = settings.cell_size;
  for (int growth = 0;; ++growth, cell_size *= kGrowth) {
    lay_out(bounds, cell_size);
    if (gather(points) >= settings.cell_points || growth == kMostGrowths) break;
  }
  find_ground(settings, accuracy);
}

void GroundSurface::build_below(std::span<const std::uint8_t> loose,
                                const GroundSurfaceSettings& settings) {
  constexpr double kLow = 0.05;  // share of a cell's points that is noise below the ground
  for (std::size_t cell = 0; cell < seen_.size(); ++cell) {
    if (loose[cell] != 0) seen_[cell] = height_in(cell, kLow);
  }
  find_ground(settings, Accuracy::full);
}

void GroundSurface::find_ground(const GroundSurfaceSettings& settings, Accuracy accuracy) {
  depressions_.clear();
  find_smooth_cells(settings.max_slope);
  const bool has_trend = settings.trend_reach > 0;
  if (!has_trend) add_planar_cells(settings.max_slope);
  find_patches(settings.max_slope);
  if (!has_trend) join_windows();
  if (has_trend) {
    trend_.fit(columns_, rows_, ground_.data(), seen_.data(), cell_, settings.trend_reach);
    trend_.add_to(seen_.data(), -1);  // from now on heights are above the trend
    join_trend(settings.tolerance);
  }
  join_patches(settings.tolerance, accuracy);
  if (has_trend) {
    trend_.add_to(seen_.data(), 1);
    trend_.add_to(smooth_.data(), 1);
  } else if (depressions_.remove({columns_, rows_, cell_, smooth_.data()}, ground_)) {
    span(RasterFill::kSteps);
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

float GroundSurface::blurred(std::size_t cell) const {
  float weight = 0, height = 0;
  for (std::size_t v = 0; v < 3; ++v) {
    for (std::size_t u = 0; u < 3; ++u) {
      const std::size_t other = cell + v * columns_ + u - columns_ - 1;
      const float z = seen_[other];
      if (ground_[other] == 0) continue;
      const float w = (u == 1 ? 2.0F : 1.0F) * (v == 1 ? 2.0F : 1.0F);
      weight += w;
      height += w * z;
    }
  }
  return weight > 0 ? height / weight : kUnseen;
}

void GroundSurface::heights_above(PointView points, std::span<float> heights) const {
  subtract_surface({smooth_.data(), static_cast<std::int32_t>(columns_),
                    static_cast<std::int32_t>(rows_), low_x_, low_y_, inverse_},
                   points.x.data(), points.y.data(), points.z.data(), points.size(),
                   heights.data());
}

float GroundSurface::height_in(std::size_t cell, double share) {
  const std::span<float> heights(z_.begin() + begin_[cell], points_in(cell));
  return heights.empty() ? kUnseen : quantile(heights, share);
}

void GroundSurface::find_smooth_cells(float max_slope) {
  ground_.assign(columns_ * rows_, 0);
  const float limit = 2 * cell_ * max_slope;
  for (std::size_t row = 1; row + 1 < rows_; ++row) {
    for (std::size_t column = 1; column + 1 < columns_; ++column) {
      const std::size_t cell = row * columns_ + column;
      if (std::isnan(seen_[cell])) continue;
      const float rise_x = rise(cell, 1, columns_), rise_y = rise(cell, columns_, 1);
      // False where a neighbour is not known.
      ground_[cell] = rise_x * rise_x + rise_y * rise_y <= limit * limit ? 1 : 0;
    }
  }
}

/// Makes smooth what lies on the plane of a window: cells without neighbours, whose slope cannot be
/// told, and those on a wide bank.
void GroundSurface::add_planar_cells(float max_slope) {
  windows_.find(columns_, rows_, seen_.data(), cell_, max_slope);
  const float limit = 2 * cell_ * max_slope;
  for_each_planar_cell([&](const PlanarWindow& window, std::size_t cell) {
    if (ground_[cell] != 0) return;
    const float rise_x = rise(cell, 1, columns_), rise_y = rise(cell, columns_, 1);
    // False where a neighbour is not known.
    const bool is_steep =
        std::hypot(rise_x - 2 * window.rise_x, rise_y - 2 * window.rise_y) > limit;
    if (!is_steep) ground_[cell] = 1;
  });
}

/// Makes one patch of those that lie on the plane of one window.
void GroundSurface::join_windows() {
  queue_.clear();  // by patch: the one that it was joined to
  for (std::uint32_t i = 0; i < patches_.size(); ++i) queue_.push_back(i);
  const PlanarWindow* last = nullptr;
  std::uint32_t root = 0;
  for_each_planar_cell([&](const PlanarWindow& window, std::size_t cell) {
    if (patch_[cell] == kNoLabel) return;
    const std::uint32_t other = root_of(queue_, patch_[cell]);
    if (&window != std::exchange(last, &window)) {
      root = other;
    } else if (other != root) {
      queue_[other] = root;
      patches_[root].cells += std::exchange(patches_[other].cells, 0);
    }
  });
  for (std::uint32_t& patch : patch_) {
    if (patch != kNoLabel) patch = root_of(queue_, patch);
  }
}

/// Calls visit(window, cell) for the cells that lie on a window's plane.
template <class Visit>
void GroundSurface::for_each_planar_cell(const Visit& visit) const {
  for (const PlanarWindow& window : windows_.all()) {
    windows_.for_each_cell(window, columns_, seen_.data(), [&](std::size_t cell, float off) {
      if (std::abs(off) <= PlanarWindows::kThickness) visit(window, cell);
    });
  }
}

float GroundSurface::rise(std::size_t cell, std::size_t along, std::size_t across) const {
  float weight = 0, rise = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t middle = cell + k * across - across;
    const float step = seen_[middle + along] - seen_[middle - along];
    if (std::isnan(step)) continue;
    const float w = k == 1 ? 2.0F : 1.0F;
    weight += w;
    rise += w * step;
  }
  return weight > 0 ? rise / weight : kUnseen;
}

void GroundSurface::find_patches(float max_slope) {
  // The heights of single cells are noisier than the rise over three of them.
  const float straight = 1.5F * max_slope * cell_, diagonal = 1.4142F * straight;
  patch_.assign(columns_ * rows_, kNoLabel);
  patches_.clear();
  for (std::uint32_t seed = 0; seed < patch_.size(); ++seed) {
    if (ground_[seed] == 0 || patch_[seed] != kNoLabel) continue;
    const auto number = static_cast<std::uint32_t>(patches_.size());
    queue_.clear();
    queue_.push_back(seed);
    patch_[seed] = number;
    for (std::size_t next = 0; next < queue_.size(); ++next) {
      const auto around = neighbours(queue_[next], columns_);
      for (std::size_t i = 0; i < around.size(); ++i) {
        const std::size_t cell = around[i];
        if (ground_[cell] == 0 || patch_[cell] != kNoLabel) continue;
        const float way = i < kSides ? straight : diagonal;
        if (std::abs(seen_[cell] - seen_[queue_[next]]) > way) continue;
        patch_[cell] = number;
        queue_.push_back(static_cast<std::uint32_t>(cell));
      }
    }
    patches_.push_back({static_cast<std::uint32_t>(queue_.size())});
  }
}

/// Makes ground of the patches that lie on the trend. A lidar's rings make many small patches, and
/// the largest of them need not be ground.
void GroundSurface::join_trend(float tolerance) {
  constexpr float kShare = 0.5F;  // the trend is not as near to the ground as the surface will be
  for (std::size_t cell = 0; cell < patch_.size(); ++cell) {
    if (patch_[cell] != kNoLabel) patches_[patch_[cell]].residual += seen_[cell];
  }
  for (Patch& patch : patches_) {
    const float cells = static_cast<float>(patch.cells);
    patch.is_ground = std::abs(patch.residual) <= kShare * tolerance * cells;
  }
}

void GroundSurface::join_patches(float tolerance, Accuracy accuracy) {
  // Patches that join let others join, which is soon at an end.
  const int rounds = accuracy == Accuracy::full ? 3 : 1;
  const std::size_t cells = columns_ * rows_;
  smooth_.resize(cells);
  if (!patches_.empty()) {
    std::ranges::max_element(patches_, {}, &Patch::cells)->is_ground = true;
  }
  mark_ground();
  for (int round = 0; round < rounds; ++round) {
    span(RasterFill::kRoughSteps);
    for (Patch& patch : patches_) patch.residual = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) {
      if (patch_[cell] == kNoLabel) continue;
      patches_[patch_[cell]].residual += seen_[cell] - smooth_[cell];
    }
    bool joined = false;
    for (Patch& patch : patches_) {
      if (patch.is_ground) continue;
      patch.is_ground = std::abs(patch.residual) <= tolerance * static_cast<float>(patch.cells);
      joined |= patch.is_ground;
    }
    if (!joined) break;
    mark_ground();
  }
  span(accuracy == Accuracy::full ? RasterFill::kSteps : RasterFill::kRoughSteps);
}

void GroundSurface::mark_ground() {
  for (std::size_t cell = 0; cell < ground_.size(); ++cell) {
    ground_[cell] = patch_[cell] != kNoLabel && patches_[patch_[cell]].is_ground ? 1 : 0;
  }
}

/// Spans the surface from the ground.
void GroundSurface::span(int steps) {
  for (std::size_t cell = 0; cell < ground_.size(); ++cell) {
    if (ground_[cell] != 0) smooth_[cell] = blurred(cell);
  }
  fill_.fill(columns_, rows_, ground_.data(), smooth_.data(), steps);
}

}  // namespace scree
