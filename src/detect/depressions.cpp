#include "scree/detect/depressions.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "scree/detect/neighbours.hpp"
#include "scree/detect/quantile.hpp"

namespace scree {
namespace {

constexpr float kShallow = 0.06F;  // metres: no deeper is a dent of the ground

}  // namespace

Depressions::Depressions(std::size_t max_cells)
    : level_(max_cells),
      shore_(max_cells),
      is_done_(max_cells),
      is_taken_(max_cells),
      cells_(max_cells),
      slopes_(max_cells) {}

bool Depressions::remove(const HeightRaster& raster, FixedVector<std::uint8_t>& ground) {
  flood(raster);
  is_done_.assign(raster.columns * raster.rows, 0);
  is_taken_.assign(raster.columns * raster.rows, 0);
  bool any = false;
  for (std::size_t cell = 0; cell < is_done_.size(); ++cell) {
    if (is_done_[cell] != 0 || level_[cell] - raster.heights[cell] <= kShallow) continue;
    collect(cell, raster);
    if (!is_crater(raster, ground)) continue;
    for (const std::uint32_t inside : cells_) {
      ground[inside] = 0;
      is_taken_[inside] = 1;
    }
    any = true;
  }
  return any;
}

void Depressions::flood(const HeightRaster& raster) {
  const std::size_t columns = raster.columns, rows = raster.rows;
  level_.resize(columns * rows);
  is_done_.assign(columns * rows, 0);
  shore_.clear();
  // The outermost cells have no neighbours: water comes in beside them.
  for (std::size_t cell = 0; cell < is_done_.size(); ++cell) {
    const std::size_t column = cell % columns, row = cell / columns;
    if (column > 0 && column + 1 < columns && row > 0 && row + 1 < rows) continue;
    is_done_[cell] = 1;
    level_[cell] = raster.heights[cell];
  }
  for (std::size_t cell = columns + 1; cell + columns + 1 < is_done_.size(); ++cell) {
    const std::size_t column = cell % columns, row = cell / columns;
    const bool is_beside = column == 1 || column + 2 == columns || row == 1 || row + 2 == rows;
    if (is_beside) reach(cell, raster.heights[cell], raster);
  }
  while (!shore_.empty()) {
    std::pop_heap(shore_.begin(), shore_.end());
    const Shore lowest = shore_.back();
    shore_.resize(shore_.size() - 1);
    for (const std::size_t next : neighbours(lowest.cell, columns)) {
      reach(next, lowest.level, raster);
    }
  }
}

/// Lets water of a level into a cell, unless some came there before.
void Depressions::reach(std::size_t cell, float level, const HeightRaster& raster) {
  if (is_done_[cell] != 0) return;
  is_done_[cell] = 1;
  level_[cell] = std::max(level, raster.heights[cell]);
  shore_.push_back({level_[cell], static_cast<std::uint32_t>(cell)});
  std::push_heap(shore_.begin(), shore_.end());
}

/// Collects the cells under water that hang together with one.
void Depressions::collect(std::size_t start, const HeightRaster& raster) {
  cells_.clear();
  const auto take = [&](std::size_t cell) {
    if (is_done_[cell] != 0 || level_[cell] - raster.heights[cell] <= kShallow) return;
    is_done_[cell] = 1;
    cells_.push_back(static_cast<std::uint32_t>(cell));
  };
  take(start);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    for (const std::size_t next : neighbours(cells_[i], raster.columns)) take(next);
  }
}

bool Depressions::is_crater(const HeightRaster& raster, const FixedVector<std::uint8_t>& ground) {
  constexpr float kDepth = 0.2F;       // metres
  constexpr float kLeastKnown = 0.3F;  // share of the area
  float depth = 0, known = 0;
  slopes_.clear();
  for (const std::uint32_t cell : cells_) {
    depth = std::max(depth, level_[cell] - raster.heights[cell]);
    if (ground[cell] != 0) ++known;
    const float* const at = raster.heights + cell;
    slopes_.push_back(std::hypot(at[1] - at[-1], at[raster.columns] - *(at - raster.columns)) /
                      (2 * raster.cell_size));
  }
  const auto cells = static_cast<float>(cells_.size());
  return depth >= kDepth && known > 0 && known >= kLeastKnown * cells &&
         has_flanks(depth, cells * raster.cell_size * raster.cell_size);
}

/// Whether slopes are as steep as no hollow's. A hollow of the ground slopes alike everywhere; a
/// crater has a floor, and flanks around it.
/// @param depth metres
/// @param area square metres
bool Depressions::has_flanks(float depth, float area) {
  constexpr double kFlanks = 0.9, kHalf = 0.5;  // shares of the area that slope less
  constexpr float kDeep = 0.25F;                // metres
  constexpr float kSteep = 0.32F;               // metres per metre
  constexpr float kGentle = 0.21F;              // the same where there is a floor
  constexpr float kFloor = 0.65F;               // its slope, as a share of the flanks'
  constexpr float kWidest = 40;                 // square metres: what is wider is a valley
  const std::span slopes(slopes_.data(), slopes_.size());
  const float flanks = quantile(slopes, kFlanks);
  if (flanks >= kSteep && depth >= kDeep) return true;
  return flanks >= kGentle && area <= kWidest && quantile(slopes, kHalf) <= kFloor * flanks;
}

}  // namespace scree
