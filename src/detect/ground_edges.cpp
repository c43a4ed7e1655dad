#include "scree/detect/ground_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace scree {
namespace {

constexpr float kLeastStep = 0.15F;    // metres
constexpr float kLeastSlope = 0.5F;    // of the way to the other level: 27 degrees
constexpr float kBend = 0.1F;          // metres a metre that ground which is not seen may bend down
constexpr float kFarthestStep = 1.5F;  // metres to the other level of a steep step
constexpr float kWidestWater = 8;      // metres
constexpr float kClutter = 0.05F;      // metres: what is higher and no ground is an obstacle
constexpr float kLeastTerrace = 1.5F;  // square metres of level ground above a step
constexpr float kDense = 60;           // cells of ground up to 0.6 m around one
constexpr std::uint16_t kFewestBeams = 4;

/// Of a step, this far from the ground that is seen.
float least_depth(float way) {
  return kLeastStep + kBend * way;
}

/// The eight directions, and none in the middle.
std::pair<int, int> direction(std::size_t i) {
  return {static_cast<int>(i % 3) - 1, static_cast<int>(i / 3) - 1};
}

}  // namespace

GroundEdges::GroundEdges(std::size_t max_cells)
    : step_(max_cells),
      ground_(max_cells),
      is_seen_(max_cells),
      cells_(max_cells),
      is_taken_(max_cells),
      order_(max_cells),
      values_(max_cells),
      places_(max_cells),
      edges_(max_cells / 16 + 1),
      row_sums_(max_cells + max_cells / 4) {}

void GroundEdges::find(const GroundSurface& surface, const HoleEvidence& beams) {
  surface_ = &surface;
  beams_ = &beams;
  const std::size_t columns = surface.columns(), cells = columns * surface.rows();
  step_.assign(cells, 0);
  ground_.assign(cells, 0);
  is_seen_.assign(cells, 0);
  is_taken_.assign(cells, 0);
  sum_rows();
  for (std::size_t row = 1; row + 1 < surface.rows(); ++row) {
    for (std::size_t column = 1; column + 1 < columns; ++column) {
      const std::size_t cell = row * columns + column;
      if (!surface.is_ground(cell) || surface.patch_area(cell) < kLeastTerrace) continue;
      look_around(cell);
    }
  }
  places_.clear();
  cells_.clear();
  edges_.clear();
  for (std::size_t cell = 0; cell < cells; ++cell) {
    if (step_[cell] == 0 || is_taken_[cell] != 0) continue;
    const std::size_t begin = cells_.size();
    collect(cell, step_[cell] > 0 ? 1 : -1);
    add_edge(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(cells_.size()), 0);
  }
}

/// Looks from a cell of the ground in all directions where it does not go on.
void GroundEdges::look_around(std::size_t cell) {
  Plane plane;
  std::array<Beyond, 9> beyond{};
  // Where it slopes down on one side, what is not seen does so, too; and so with water.
  bool is_gentle = false, is_water = false;
  for (std::size_t i = 0; i < beyond.size(); ++i) {
    const auto [along_x, along_y] = direction(i);
    const std::size_t next = cell + static_cast<std::size_t>(along_x) +
                             static_cast<std::size_t>(along_y) * surface_->columns();
    if (surface_->is_ground(next)) continue;
    if (plane.cells == 0 && !fit(cell, plane)) return;
    beyond[i] = look(cell, along_x, along_y, plane);
    is_gentle |= beyond[i].is_gentle;
    is_water |= beyond[i].is_water;
  }
  for (std::size_t i = 0; i < beyond.size(); ++i) {
    const bool goes_on = is_gentle || (is_water && !beyond[i].has_return);
    if (beyond[i].step == 0 || (!beyond[i].is_seen && goes_on)) continue;
    const auto [along_x, along_y] = direction(i);
    mark(cell, along_x, along_y, beyond[i], plane.height);
  }
}

/// Sums up each row of the raster, so that the sums over any stretch of it are at hand.
void GroundEdges::sum_rows() {
  const std::size_t columns = surface_->columns(), rows = surface_->rows();
  row_sums_.resize((columns + 1) * rows);
  RowSums* out = row_sums_.data();
  for (std::size_t row = 0; row < rows; ++row) {
    RowSums sums;
    *out++ = sums;
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t cell = row * columns + column;
      if (surface_->is_ground(cell)) {
        const auto x = static_cast<double>(column), z = static_cast<double>(surface_->seen(cell));
        ++sums.cells;
        sums.x += x;
        sums.xx += x * x;
        sums.z += z;
        sums.xz += x * z;
      }
      *out++ = sums;
    }
  }
}

/// Lays a plane through the ground around a cell. False where too little of it is known.
bool GroundEdges::fit(std::size_t cell, Plane& plane) const {
  constexpr float kReach = 0.6F;  // metres
  constexpr double kFewest = 8;
  const auto reach = static_cast<std::size_t>(kReach / surface_->cell_size());
  const std::size_t columns = surface_->columns();
  const std::size_t row = cell / columns, column = cell % columns;
  const std::size_t left = column - std::min(column, reach);
  const std::size_t right = std::min(column + reach + 1, columns);
  const auto middle = static_cast<double>(column);
  double count = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, yy = 0, xz = 0, yz = 0;
  for (std::size_t v = row - std::min(row, reach); v <= std::min(row + reach, surface_->rows() - 1);
       ++v) {
    const RowSums* const sums = row_sums_.data() + v * (columns + 1);
    const RowSums in_row = sums[right] - sums[left];
    const double py = static_cast<double>(v) - static_cast<double>(row);
    const double px = in_row.x - middle * in_row.cells;
    count += in_row.cells;
    x += px;
    y += py * in_row.cells;
    z += in_row.z;
    xx += in_row.xx - middle * (in_row.x + px);
    xy += py * px;
    yy += py * py * in_row.cells;
    xz += in_row.xz - middle * in_row.z;
    yz += py * in_row.z;
  }
  plane.cells = static_cast<float>(count);
  if (count < kFewest) return false;
  // A ridge keeps the slope small across a single ring of the lidar, where nothing tells it.
  const double ridge = 2 * count;
  xx += ridge - x * x / count;
  yy += ridge - y * y / count;
  xy -= x * y / count;
  xz -= x * z / count;
  yz -= y * z / count;
  const double determinant = xx * yy - xy * xy;
  const double rise_x = (xz * yy - yz * xy) / determinant;
  const double rise_y = (yz * xx - xz * xy) / determinant;
  plane.rise_x = static_cast<float>(rise_x);
  plane.rise_y = static_cast<float>(rise_y);
  plane.height = static_cast<float>((z - rise_x * x - rise_y * y) / count);
  return true;
}

/// How many steps from a cell stay on the raster.
int GroundEdges::steps_inside(std::size_t cell, int along_x, int along_y) const {
  const auto left = [](std::size_t at, std::size_t count, int along) {
    if (along == 0) return std::numeric_limits<int>::max();
    return static_cast<int>(along > 0 ? count - 1 - at : at);
  };
  const std::size_t columns = surface_->columns();
  return std::min(left(cell % columns, columns, along_x),
                  left(cell / columns, surface_->rows(), along_y));
}

GroundEdges::Beyond GroundEdges::look(std::size_t cell, int along_x, int along_y,
                                      const Plane& plane) const {
  const float stride = surface_->cell_size() * (along_x != 0 && along_y != 0 ? 1.4142F : 1.0F);
  const int inside = steps_inside(cell, along_x, along_y);
  const int steps = std::min(static_cast<int>(kFarthest / stride), inside);
  const auto offset =
      static_cast<std::ptrdiff_t>(along_x) +
      static_cast<std::ptrdiff_t>(along_y) * static_cast<std::ptrdiff_t>(surface_->columns());
  const float rise =
      plane.rise_x * static_cast<float>(along_x) + plane.rise_y * static_cast<float>(along_y);
  Beyond unseen;
  for (int i = 1; i <= steps; ++i) {
    const std::size_t at = cell + static_cast<std::size_t>(offset * i);
    const float way = static_cast<float>(i) * stride;
    const float level = plane.height + rise * static_cast<float>(i);
    if (surface_->points_in(at) == 0) {
      if (beams_->lost_beams(at) < kFewestBeams) continue;
      if (unseen.cells == 0) unseen.cells = i;
      // Ground that rises levels off sooner or later.
      const float highest = std::min(level, plane.height);
      const float depth = highest - beams_->lowest_beam(at);
      unseen.has_return |= highest - beams_->lowest_return(at) >= least_depth(way);
      if (depth < least_depth(way) || plane.cells < kDense) continue;
      unseen.step = std::min(unseen.step, -depth);
      continue;
    }
    // Where ground is seen, what lies below it is a reflection.
    const float top = surface_->top(at) - level;
    const float middle = surface_->seen(at) - level;
    const float step = top <= -kLeastStep ? top : std::max(middle, -kLeastStep / 2);
    if (std::abs(step) < kLeastStep) {
      if (surface_->is_ground(at)) return {.is_gentle = unseen.step != 0};
      if (step > kClutter) return {};
      continue;
    }
    const bool is_steep =
        way <= kFarthestStep && std::abs(step) >= kLeastSlope * (way - stride / 2);
    if (step > 0) {
      if (!is_steep) return {};
      if (surface_->patch_area(at) < kLeastTerrace) continue;
      return {.step = step, .is_seen = true};
    }
    if (is_steep && !is_level_next(at, offset, level, rise)) return {.step = step, .is_seen = true};
    if (unseen.step != 0 && goes_on_level(at, offset, rise, steps - i)) {
      return {.step = step, .cells = unseen.cells};
    }
    return {.is_gentle = true};
  }
  if (unseen.step != 0 && !unseen.has_return) {
    const int farthest = std::min(static_cast<int>(kWidestWater / stride), inside);
    if (ends_water(cell, offset, plane.height, stride, steps + 1, farthest)) {
      return {.is_water = true};
    }
  }
  return unseen;
}

/// Whether ground at the level of a cell is seen beyond a gap from which no beam came back: still
/// water throws it away. In a pit, or below an edge, the beams end on something.
bool GroundEdges::ends_water(std::size_t cell, std::ptrdiff_t offset, float level, float stride,
                             int begin, int end) const {
  for (int i = begin; i <= end; ++i) {
    const std::size_t at = cell + static_cast<std::size_t>(offset * i);
    const float least = least_depth(stride * static_cast<float>(i));
    if (surface_->points_in(at) > 0) {
      return surface_->is_ground(at) && std::abs(surface_->seen(at) - level) < least;
    }
    if (level - beams_->lowest_return(at) >= least) return false;
  }
  return false;
}

/// Whether something is seen at the ground's level shortly beyond a cell: then what lies below that
/// level is a reflection, or a narrow hole.
bool GroundEdges::is_level_next(std::size_t cell, std::ptrdiff_t offset, float level,
                                float rise) const {
  constexpr int kCells = 2;
  for (int i = 1; i <= kCells; ++i) {
    const std::size_t next = cell + static_cast<std::size_t>(offset * i);
    if (!surface_->has_neighbours(next)) return false;
    if (surface_->points_in(next) == 0) continue;
    if (surface_->top(next) - level - rise * static_cast<float>(i) > -kLeastStep) return true;
  }
  return false;
}

/// Whether the ground goes on from a cell as it does before the edge: a hollow rises again.
bool GroundEdges::goes_on_level(std::size_t cell, std::ptrdiff_t offset, float rise,
                                int steps) const {
  constexpr float kOff = 0.06F;  // metres
  constexpr int kFewest = 4, kMost = 15;
  const float height = surface_->seen(cell);
  int seen = 0, level = 0;
  for (int i = 1; i <= std::min(steps, kMost); ++i) {
    const std::size_t at = cell + static_cast<std::size_t>(offset * i);
    if (surface_->points_in(at) == 0) continue;
    ++seen;
    if (std::abs(surface_->seen(at) - height - rise * static_cast<float>(i)) < kOff) ++level;
  }
  return seen >= kFewest && level * 5 >= seen * 4;
}

/// Marks the cells beyond an edge.
void GroundEdges::mark(std::size_t cell, int along_x, int along_y, const Beyond& beyond,
                       float ground) {
  const float stride = surface_->cell_size() * (along_x != 0 && along_y != 0 ? 1.4142F : 1.0F);
  const auto offset =
      static_cast<std::ptrdiff_t>(along_x) +
      static_cast<std::ptrdiff_t>(along_y) * static_cast<std::ptrdiff_t>(surface_->columns());
  const int strip = static_cast<int>(kStrip / stride);
  // Where nothing is seen, the edge lies between the last ground and the first beam that passed.
  const int wide = std::min(std::max(strip, beyond.cells), steps_inside(cell, along_x, along_y));
  for (int i = 1; i <= wide; ++i) {
    const std::size_t at = cell + static_cast<std::size_t>(offset * i);
    if (surface_->is_ground(at)) continue;
    if (std::abs(beyond.step) > std::abs(step_[at])) step_[at] = beyond.step;
    ground_[at] = ground;
    if (beyond.is_seen) is_seen_[at] = 1;
  }
}

}  // namespace scree
