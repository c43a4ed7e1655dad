#include "scree/detect/raster_fill.hpp"

#include <algorithm>

namespace scree {
namespace {

/// A pyramid over n cells has at most n + n/2 + n/4 + ... cells (a row of single cells halves only
/// one way), and one more a level for odd sides.
std::size_t pyramid_cells(std::size_t cells, std::size_t levels) {
  return 2 * cells + 4 * levels;
}

/// Relaxes all cells of a row at once. The cell to the left of each has not been relaxed yet then,
/// which costs less than waiting for it.
/// @param above, below the next rows; at the raster's edge the row itself
/// @param weights 1 for cells that stay, 0 for the others
/// @param relaxed room for a row
void relax_row(float* here, const float* above, const float* below, const float* weights,
               float* relaxed, std::size_t columns) {
  const auto mean = [=](std::size_t left, std::size_t i, std::size_t right) {
    return 0.25F * ((here[left] + here[right]) + (above[i] + below[i]));
  };
  const std::size_t last = columns - 1;
  relaxed[0] = mean(0, 0, std::min(last, std::size_t{1}));
  for (std::size_t i = 1; i < last; ++i) relaxed[i] = mean(i - 1, i, i + 1);
  if (last > 0) relaxed[last] = mean(last - 1, last, last);
  for (std::size_t i = 0; i < columns; ++i) {
    here[i] = weights[i] * here[i] + (1 - weights[i]) * relaxed[i];
  }
}

}  // namespace

RasterFill::RasterFill(std::size_t max_cells)
    : levels_(kMostLevels),
      heights_(2 * pyramid_cells(max_cells, kMostLevels)),
      weights_(2 * pyramid_cells(max_cells, kMostLevels)),
      relaxed_(max_cells) {}

void RasterFill::fill(std::size_t columns, std::size_t rows, const std::uint8_t* known,
                      float* heights) {
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
    relax(levels_[k - 1]);
  }
  std::copy_n(heights_.begin(), cells, heights);
}

void RasterFill::pull(const Level& fine, const Level& coarse) {
  for (std::size_t row = 0; row < coarse.rows; ++row) {
    for (std::size_t column = 0; column < coarse.columns; ++column) {
      float weight = 0, height = 0;
      for (std::size_t v = 2 * row; v < std::min(2 * row + 2, fine.rows); ++v) {
        for (std::size_t u = 2 * column; u < std::min(2 * column + 2, fine.columns); ++u) {
          weight += weights_[fine.at(u, v)];
          height += weights_[fine.at(u, v)] * heights_[fine.at(u, v)];
        }
      }
      const std::size_t cell = coarse.at(column, row);
      heights_[cell] = weight > 0 ? height / weight : 0.0F;
      weights_[cell] = std::min(weight, 1.0F);
    }
  }
}

void RasterFill::push(const Level& coarse, const Level& fine) {
  for (std::size_t row = 0; row < fine.rows; ++row) {
    // Bilinear: the coarse cell that holds this one counts 3/4 on each axis, the next one 1/4.
    const std::size_t near_row = row / 2;
    const std::size_t far_row =
        row % 2 == 0 ? near_row - (near_row > 0 ? 1 : 0) : std::min(near_row + 1, coarse.rows - 1);
    for (std::size_t column = 0; column < fine.columns; ++column) {
      if (weights_[fine.at(column, row)] > 0) continue;
      const std::size_t near = column / 2;
      const std::size_t far =
          column % 2 == 0 ? near - (near > 0 ? 1 : 0) : std::min(near + 1, coarse.columns - 1);
      heights_[fine.at(column, row)] = 0.5625F * heights_[coarse.at(near, near_row)] +
                                       0.1875F * heights_[coarse.at(far, near_row)] +
                                       0.1875F * heights_[coarse.at(near, far_row)] +
                                       0.0625F * heights_[coarse.at(far, far_row)];
    }
  }
}

void RasterFill::relax(const Level& level) {
  constexpr int kSteps = 12;  // smooths a level over a few cells; the coarser ones did the rest
  relaxed_.resize(level.columns);
  for (int step = 0; step < kSteps; ++step) {
    for (std::size_t row = 0; row < level.rows; ++row) {
      const std::size_t first = level.at(0, row);
      float* const here = heights_.data() + first;
      relax_row(here, row > 0 ? here - level.columns : here,
                row + 1 < level.rows ? here + level.columns : here, weights_.data() + first,
                relaxed_.data(), level.columns);
    }
  }
}

}  // namespace scree
