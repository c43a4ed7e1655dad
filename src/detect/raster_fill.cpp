#include "scree/detect/raster_fill.hpp"

#include <algorithm>

#include "scree/detect/multiversion.hpp"

namespace scree {
namespace {

/// A pyramid over n cells has at most n + n/2 + n/4 + ... cells (a row of single cells halves only
/// one way), and one more a level for odd sides.
std::size_t pyramid_cells(std::size_t cells, std::size_t levels) {
  return 2 * cells + 4 * levels;
}

/// Relaxes all cells of a level once, row by row. The cell to the left of each has not been relaxed
/// yet then, which costs less than waiting for it.
/// @param weights 1 for cells that stay, 0 for the others
/// @param relaxed room for a row
SCREE_MULTIVERSION
void relax_rows(float* heights, const float* weights, float* relaxed, std::size_t columns,
                std::size_t rows) {
  const std::size_t last = columns - 1;
  for (std::size_t row = 0; row < rows; ++row, heights += columns, weights += columns) {
    // At the raster's edge the row itself stands for the one beyond.
    const float* const above = row > 0 ? heights - columns : heights;
    const float* const below = row + 1 < rows ? heights + columns : heights;
    const auto mean = [=](std::size_t left, std::size_t i, std::size_t right) {
      return 0.25F * ((heights[left] + heights[right]) + (above[i] + below[i]));
    };
    relaxed[0] = mean(0, 0, std::min(last, std::size_t{1}));
    for (std::size_t i = 1; i < last; ++i) relaxed[i] = mean(i - 1, i, i + 1);
    if (last > 0) relaxed[last] = mean(last - 1, last, last);
    for (std::size_t i = 0; i < columns; ++i) {
      heights[i] = weights[i] * heights[i] + (1 - weights[i]) * relaxed[i];
    }
  }
}

/// Gives a row bilinear heights between those of two coarse rows. The coarse cell that holds one
/// counts 3/4 on each axis, the next one 1/4.
/// @param between room for a coarse row
/// @param weights 1 for cells that stay, 0 for the others
SCREE_MULTIVERSION
void push_row(const float* near, const float* far, float* __restrict between,
              std::size_t coarse_columns, const float* weights, float* __restrict heights,
              std::size_t columns) {
  constexpr float kNear = 0.75F, kFar = 0.25F;
  for (std::size_t i = 0; i < coarse_columns; ++i) between[i] = kNear * near[i] + kFar * far[i];
  const auto fill = [=](std::size_t cell, std::size_t here, std::size_t next) {
    const float height = kNear * between[here] + kFar * between[next];
    heights[cell] = weights[cell] > 0 ? heights[cell] : height;
  };
  const std::size_t last = coarse_columns - 1, pairs = columns / 2;
  fill(0, 0, 0);
  for (std::size_t i = 1; i < (columns + 1) / 2; ++i) fill(2 * i, i, i - 1);
  for (std::size_t i = 0; i + 1 < pairs; ++i) fill(2 * i + 1, i, i + 1);
  if (pairs > 0) fill(2 * pairs - 1, pairs - 1, std::min(pairs, last));
}

/// The mean of the known cells among four, two above two, and whether there are any.
struct KnownMean {
  float height = 0, weight = 0;
  void add(float cell_weight, float cell_height) {
    weight += cell_weight;
    height += cell_weight * cell_height;
  }
};

}  // namespace

RasterFill::RasterFill(std::size_t max_cells)
    : levels_(kMostLevels),
      heights_(2 * pyramid_cells(max_cells, kMostLevels)),
      weights_(2 * pyramid_cells(max_cells, kMostLevels)),
      relaxed_(max_cells) {}

void RasterFill::fill(std::size_t columns, std::size_t rows, const std::uint8_t* known,
                      float* heights, int steps) {
  levels_.clear();
  levels_.push_back({columns, rows, 0});
  while (std::max(levels_.back().columns, levels_.back().rows) > 1) {
    const Level& fine = levels_.back();
    levels_.push_back(
        {(fine.columns + 1) / 2, (fine.rows + 1) / 2, fine.first + fine.columns * fine.rows});
  }
  const std::size_t cells = columns * rows;
  for (std::size_t i = 0; i < cells; ++i) {
    weights_[i] = known[i] != 0 ? 1.0F : 0.0F;
    heights_[i] = known[i] != 0 ? heights[i] : 0.0F;
  }
  for (std::size_t k = 1; k < levels_.size(); ++k) pull(levels_[k - 1], levels_[k]);
  for (std::size_t k = levels_.size() - 1; k > 0; --k) {
    push(levels_[k], levels_[k - 1]);
    relax(levels_[k - 1], steps);
  }
  std::copy_n(heights_.begin(), cells, heights);
}

void RasterFill::pull(const Level& fine, const Level& coarse) {
  for (std::size_t row = 0; row < coarse.rows; ++row) {
    const bool has_second_row = 2 * row + 1 < fine.rows;
    const std::size_t first = fine.at(0, 2 * row);
    const std::size_t second = has_second_row ? fine.at(0, 2 * row + 1) : first;
    for (std::size_t column = 0; column < coarse.columns; ++column) {
      const std::size_t left = 2 * column, right = left + 1;
      KnownMean mean;
      mean.add(weights_[first + left], heights_[first + left]);
      if (right < fine.columns) mean.add(weights_[first + right], heights_[first + right]);
      if (has_second_row) {
        mean.add(weights_[second + left], heights_[second + left]);
        if (right < fine.columns) mean.add(weights_[second + right], heights_[second + right]);
      }
      const std::size_t cell = coarse.at(column, row);
      heights_[cell] = mean.weight > 0 ? mean.height / mean.weight : 0.0F;
      weights_[cell] = std::min(mean.weight, 1.0F);
    }
  }
}

void RasterFill::push(const Level& coarse, const Level& fine) {
  relaxed_.resize(coarse.columns);
  for (std::size_t row = 0; row < fine.rows; ++row) {
    const std::size_t near = row / 2;
    const std::size_t far =
        row % 2 == 0 ? near - (near > 0 ? 1 : 0) : std::min(near + 1, coarse.rows - 1);
    push_row(heights_.data() + coarse.at(0, near), heights_.data() + coarse.at(0, far),
             relaxed_.data(), coarse.columns, weights_.data() + fine.at(0, row),
             heights_.data() + fine.at(0, row), fine.columns);
  }
}

void RasterFill::relax(const Level& level, int steps) {
  for (int step = 0; step < steps; ++step) {
    relax_rows(heights_.data() + level.first, weights_.data() + level.first, relaxed_.data(),
               level.columns, level.rows);
  }
}

}  // namespace scree
